#include "hybrid_sphere/ros/surface_markers.hpp"

#include <algorithm>

#include "hybrid_sphere/ros/marker_tools.hpp"
#include "hybrid_sphere/ros/surface_labels.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

std_msgs::ColorRGBA color_of(scene::Law law) {
  switch (law) {
    case scene::Law::smooth: return color(0.72, 0.86, 0.95);
    case scene::Law::rough: return color(0.88, 0.74, 0.52);
  }
  return color(0.5, 0.5, 0.5);
}

const std_msgs::ColorRGBA ink = color(0.10, 0.10, 0.12);

/// Draws one map into a message.
class Painter {
 public:
  Painter(const scene::Surface& surface, const ViewSquare& view, double radius,
          const std::string& world_frame)
      : view_(view),
        frame_(world_frame),
        step_(std::min(1e-3 * view.half, 0.3 * radius / static_cast<double>(surface.regions.size() + 1))) {
    Marker clear = make_marker(frame_, "", 0, Marker::CUBE);
    clear.action = Marker::DELETEALL;
    array_.markers.push_back(clear);
  }

  /// @param id     order of the region, 0 for the base
  /// @param depth  number of regions that lie over it, itself included
  void paint(std::size_t id, std::size_t depth, scene::Law law, const Outline& outline) {
    const double z = -step_ * static_cast<double>(depth);
    Marker& fill = add("regions", id, Marker::TRIANGLE_LIST);
    fill.scale.x = fill.scale.y = fill.scale.z = 1;
    fill.color = color_of(law);
    set_points(outline.triangles, z, fill);
    fill.colors.assign(fill.points.size(), fill.color);  // rviz shades only what has one colour
    Marker& edge = add("edges", id, Marker::LINE_LIST);
    edge.scale.x = 2.5e-3 * view_.half;
    edge.color = ink;
    set_points(outline.edges, z + 0.5 * step_, edge);
  }

  void write(std::size_t id, const std::string& text, const Label& label) {
    if (!label.visible) return;
    Marker& name = add("names", id, Marker::TEXT_VIEW_FACING);
    name.text = text;
    name.color = ink;
    // A letter is about half as wide as it is high.
    const double fitting = 2.4 * label.room / (0.55 * static_cast<double>(text.size()));
    name.scale.z = std::clamp(fitting, 0.018 * view_.half, 0.05 * view_.half);
    name.pose.position = point(label.position.x(), label.position.y(), 0.7 * name.scale.z);
  }

  MarkerArray take() {
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

  static void set_points(const std::vector<Vector2d>& from, double z, Marker& marker) {
    for (const Vector2d& p : from) marker.points.push_back(point(p.x(), p.y(), z));
  }

  const ViewSquare& view_;
  const std::string& frame_;
  double step_;
  MarkerArray array_;
};

Outline everywhere(const ViewSquare& view) {
  const std::vector<Vector2d> c = view.corners();
  return {{c[0], c[1], c[2], c[0], c[2], c[3]}, {}};
}

std::string legend(const std::string& name, scene::Law law) { return name + ": " + scene::to_string(law); }

}  // namespace

MarkerArray surface_markers(const scene::Surface& surface, const ViewSquare& view, double radius,
                            const std::string& world_frame) {
  Painter painter(surface, view, radius, world_frame);
  const std::vector<Label> labels = find_labels(surface, view);
  const std::size_t n = surface.regions.size();
  painter.paint(0, n + 1, surface.base, everywhere(view));
  painter.write(0, legend(scene::base_name, surface.base), labels[n]);
  for (std::size_t i = 0; i < n; ++i) {
    const scene::Region& region = surface.regions[i];
    painter.paint(i + 1, n - i, region.law, outline_of(region.shape, view));
    painter.write(i + 1, legend(region.name, region.law), labels[i]);
  }
  return painter.take();
}

}  // namespace hybrid_sphere::ros_interface
