#include "ros/markers/surface_markers.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "interrupt/interrupt.hpp"
#include "ros/markers/cell_outline.hpp"
#include "ros/markers/ground_motion.hpp"
#include "ros/markers/marker_tools.hpp"
#include "ros/markers/region_names.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

std_msgs::ColorRGBA color_of(scene::Law law) {
  switch (law) {
    case scene::Law::smooth: return color(0.72, 0.86, 0.95);
    case scene::Law::rough: return color(0.88, 0.74, 0.52);
    case scene::Law::rubber: return color(0.62, 0.60, 0.66);
    case scene::Law::coulomb: return color(0.78, 0.85, 0.62);
  }
  return color(0.5, 0.5, 0.5);
}

constexpr std::array<scene::Law, 4> laws{scene::Law::smooth, scene::Law::rough, scene::Law::rubber,
                                         scene::Law::coulomb};
constexpr std::size_t max_sides = 100'000;             // of all circles
constexpr std::size_t max_filled_corners = 4U << 20U;  // of all polygons; others are drawn by their edge
const std_msgs::ColorRGBA ink = color(0.10, 0.10, 0.12);

/// Draws one map into a message.
class Painter {
 public:
  /// @param unit  measure of lines [m]
  Painter(const scene::Surface& surface, const ViewSquare& view, double unit, double radius,
          const std::string& world_frame)
      : unit_(unit),
        frame_(world_frame),
        step_(std::min(1e-3 * view.half, 0.3 * radius / static_cast<double>(surface.regions.size() + 1))),
        edges_(make_marker(frame_, "edges", 0, Marker::LINE_LIST)) {
    Marker clear = make_marker(frame_, "", 0, Marker::CUBE);
    clear.action = Marker::DELETEALL;
    array_.markers.push_back(clear);
    for (const scene::Law law : laws) {
      fills_.push_back(make_marker(frame_, "regions", static_cast<std::int32_t>(law), Marker::TRIANGLE_LIST));
      fills_.back().scale.x = fills_.back().scale.y = fills_.back().scale.z = 1;
      fills_.back().color = color_of(law);
    }
    edges_.scale.x = 2.5e-3 * unit_;
    edges_.color = ink;
  }

  /// @param depth  number of regions that lie over it, itself included
  void paint(std::size_t depth, scene::Law law, const Outline& outline) {
    const double z = -step_ * static_cast<double>(depth);
    add_points(outline.triangles, z, fills_[static_cast<std::size_t>(law)]);
    add_points(outline.edges, z + 0.5 * step_, edges_);
  }

  void show_motion(const std::vector<Vector2d>& lines) {
    Marker& motion = add("motion", 0, Marker::LINE_LIST);
    motion.scale.x = 3e-3 * unit_;
    motion.color = color(0.05, 0.35, 0.30);
    add_points(lines, 0, motion);
  }

  void write(const RegionName& name) {
    Marker& text = add("names", names_++, Marker::TEXT_VIEW_FACING);
    text.text = name.text;
    text.color = ink;
    text.scale.z = name.size;
    text.pose.position = point(name.middle.x(), name.middle.y(), 0.7 * name.size);
  }

  MarkerArray take() {
    for (Marker& fill : fills_) {
      fill.colors.assign(fill.points.size(), fill.color);  // rviz shades only what has one colour
      array_.markers.push_back(std::move(fill));
    }
    array_.markers.push_back(std::move(edges_));
    // rviz complains about empty lists.
    const auto is_empty = [](const Marker& marker) {
      return marker.points.empty() &&
             (marker.type == Marker::TRIANGLE_LIST || marker.type == Marker::LINE_LIST);
    };
    array_.markers.erase(std::remove_if(array_.markers.begin(), array_.markers.end(), is_empty),
                         array_.markers.end());
    return std::move(array_);
  }

 private:
  Marker& add(const char* name, std::size_t id, std::int32_t type) {
    array_.markers.push_back(make_marker(frame_, name, static_cast<std::int32_t>(id), type));
    return array_.markers.back();
  }

  static void add_points(const std::vector<Vector2d>& from, double z, Marker& marker) {
    for (const Vector2d& p : from) marker.points.push_back(point(p.x(), p.y(), z));
  }

  double unit_;
  std::size_t names_ = 0;
  const std::string& frame_;
  double step_;
  std::vector<Marker> fills_;  // of each law
  Marker edges_;
  MarkerArray array_;
};

Outline everywhere(const ViewSquare& view) {
  const std::vector<Vector2d> c = view.corners();
  return {{c[0], c[1], c[2], c[0], c[2], c[3]}, {}};
}

/// Circles of many have fewer sides, so that the message stays bounded.
Detail detail_for(std::size_t regions) {
  Detail detail;
  detail.circle_sides = std::clamp(static_cast<int>(max_sides / (regions + 1)), 12, detail.circle_sides);
  return detail;
}

/// First the names in the picture, then those of small regions elsewhere on the square.
std::vector<RegionName> names_in(const Ground& ground, const ViewSquare& view,
                                 const std::vector<RegionId>& leaders, Picture* picture) {
  if (picture == nullptr) return region_names(ground, view, leaders);
  const auto look_in = [&](const ViewSquare& square, bool is_elsewhere) {
    const NameSettings settings{picture->unit,
                                !is_elsewhere,
                                is_elsewhere,
                                {picture->square.center, picture->unit},
                                std::move(picture->names)};
    picture->names = region_names(ground, square, leaders, settings);
  };
  look_in(picture->square, false);
  look_in(picture->wide_square, false);
  look_in(view, true);
  return picture->names;
}

std::size_t corners_of(const scene::Shape& shape) {
  const auto* polygon = std::get_if<scene::Polygon>(&shape);
  return polygon ? polygon->vertices.size() : 0;
}

}  // namespace

MarkerArray surface_markers(const Ground& ground, const ViewSquare& view, double radius,
                            const std::string& world_frame, Picture* picture) {
  const scene::Surface& surface = ground.surface();
  const double unit = picture != nullptr ? picture->unit : view.half;
  Painter painter(surface, view, unit, radius, world_frame);
  CellOutline cells = cell_outline(surface);
  const std::vector<RegionName> names = names_in(ground, view, cells.leaders, picture);
  const std::size_t n = surface.regions.size();
  painter.paint(n + 1, surface.base.law, everywhere(view));
  Detail detail = detail_for(n);
  std::size_t filled = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const scene::Region& region = surface.regions[i];
    interruption_point();
    filled += corners_of(region.shape);
    detail.fills = filled <= max_filled_corners;
    Outline outline = outline_of(region.shape, view, detail);
    // Of cells the edges between them are none; all edges lie over the last of them.
    if (i < surface.image_regions) outline.edges.clear();
    if (i + 1 == surface.image_regions) outline.edges = std::move(cells.edges);
    painter.paint(n - i, region.material.law, outline);
  }
  for (const RegionName& name : names) painter.write(name);
  painter.show_motion(motion_arrows(ground, view, names, unit));
  return painter.take();
}

}  // namespace hybrid_sphere::ros_interface
