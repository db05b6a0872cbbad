#include "ros/markers/slip_arrow.hpp"

#include <algorithm>

#include "ros/markers/marker_tools.hpp"

namespace hybrid_sphere::ros_interface {

using visualization_msgs::Marker;

SlipArrow::SlipArrow(const Frames& frames, double radius)
    : arrow_(make_marker(frames.world, "slip", 0, Marker::ARROW)), height_(0.1 * radius) {
  arrow_.color = color(1.00, 0.55, 0.00);
  arrow_.scale.x = 0.15 * radius;  // shaft
  arrow_.scale.y = 0.35 * radius;  // head
  arrow_.points.resize(2);
}

void SlipArrow::add_to(visualization_msgs::MarkerArray& markers, const State& state, bool all) {
  constexpr double length_per_speed = 1;  // [s]
  const bool slips = !state.slip.isZero(0);
  if (!slips && !shown_ && !all) return;
  shown_ = slips;
  arrow_.action = slips ? Marker::ADD : Marker::DELETE;
  const Vector2d tip = state.position + length_per_speed * state.slip;
  arrow_.points[0] = point(state.position.x(), state.position.y(), height_);
  arrow_.points[1] = point(tip.x(), tip.y(), height_);
  // A head no longer than the arrow.
  arrow_.scale.z = std::min(1.4 * arrow_.scale.y, 0.5 * length_per_speed * state.slip.norm());
  markers.markers.push_back(arrow_);
}

}  // namespace hybrid_sphere::ros_interface
