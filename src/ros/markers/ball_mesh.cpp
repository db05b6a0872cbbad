#include "ros/markers/ball_mesh.hpp"

#include <array>
#include <cmath>

#include "ros/markers/marker_tools.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

using visualization_msgs::Marker;

constexpr int bands = 24;  // between the poles
constexpr int meridians = 48;
constexpr int sectors = 6;    // of the pattern
constexpr int cap_bands = 3;  // at each pole

geometry_msgs::Point at(double radius, int band, int meridian) {
  const double from_pole = M_PI * band / bands;
  const double around = 2 * M_PI * meridian / meridians;
  return point(radius * std::sin(from_pole) * std::cos(around),
               radius * std::sin(from_pole) * std::sin(around), radius * std::cos(from_pole));
}

const std::array<std_msgs::ColorRGBA, 6> colors{color(0.90, 0.12, 0.14), color(1.00, 1.00, 1.00),
                                                color(0.12, 0.35, 0.85), color(1.00, 0.82, 0.12),
                                                color(0.15, 0.65, 0.30), color(1.00, 0.50, 0.10)};

/// Index of a colour: a cap at each pole, and between them red, blue and yellow stripes with white ones
/// between.
std::size_t color_at(int band, int meridian) {
  constexpr std::array<std::size_t, sectors> stripes{0, 1, 2, 1, 3, 1};
  if (band < cap_bands) return 4;
  if (band >= bands - cap_bands) return 5;
  return stripes[static_cast<std::size_t>(meridian * sectors / meridians)];
}

}  // namespace

visualization_msgs::MarkerArray ball_markers(const Frames& frames, double radius) {
  visualization_msgs::MarkerArray ball;
  for (std::size_t i = 0; i < colors.size(); ++i) {
    Marker part = make_marker(frames.sphere, "sphere", static_cast<std::int32_t>(i), Marker::TRIANGLE_LIST);
    part.frame_locked = true;
    part.scale.x = part.scale.y = part.scale.z = 1;
    part.color = colors[i];
    ball.markers.push_back(part);
  }
  for (int band = 0; band < bands; ++band) {
    for (int meridian = 0; meridian < meridians; ++meridian) {
      auto& points = ball.markers[color_at(band, meridian)].points;
      const auto upper_left = at(radius, band, meridian);
      const auto upper_right = at(radius, band, meridian + 1);
      const auto lower_left = at(radius, band + 1, meridian);
      const auto lower_right = at(radius, band + 1, meridian + 1);
      if (band + 1 < bands) points.insert(points.end(), {upper_left, lower_left, lower_right});
      if (band > 0) points.insert(points.end(), {upper_left, lower_right, upper_right});
    }
  }
  return ball;
}

}  // namespace hybrid_sphere::ros_interface
