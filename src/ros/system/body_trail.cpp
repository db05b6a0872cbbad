#include "ros/system/body_trail.hpp"

#include <cstddef>

#include "ros/markers/marker_tools.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

constexpr std::size_t longest = 2000;  // points

}  // namespace

BodyTrail::BodyTrail(const std::string& world_frame, double width)
    : line_(make_marker(world_frame, "trail", 0, visualization_msgs::Marker::LINE_STRIP)) {
  line_.scale.x = width;
  line_.color.a = 1;
}

void BodyTrail::add(double time, const Eigen::Vector3d& place, bool is_constrained) {
  if (time < last_) {
    line_.points.clear();
    line_.colors.clear();
  } else if (time == last_) {
    return;
  }
  last_ = time;
  if (line_.points.size() == longest) {
    // Half of it at once, so that a point is moved once on the average.
    line_.points.erase(line_.points.begin(), line_.points.begin() + longest / 2);
    line_.colors.erase(line_.colors.begin(), line_.colors.begin() + longest / 2);
  }
  line_.points.push_back(point(place.x(), place.y(), place.z()));
  line_.colors.push_back(is_constrained ? color(0.30, 0.10, 0.50) : color(0.50, 0.55, 0.60));
}

}  // namespace hybrid_sphere::ros_interface
