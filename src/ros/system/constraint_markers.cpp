#include "ros/system/constraint_markers.hpp"

#include <algorithm>
#include <cstdio>

#include "ros/markers/marker_tools.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

using Eigen::Vector3d;
using visualization_msgs::Marker;

constexpr std::size_t max_impulses = 50;
constexpr double letter_size = 0.022;  // in units of the picture

Vector3d vector_of(const geometry_msgs::Point& p) { return {p.x, p.y, p.z}; }

Vector2d in_picture(const Vector3d& place) { return ros_interface::in_picture(place.head<2>(), place.z()); }

}  // namespace

ConstraintMarkers::ConstraintMarkers(const std::string& world_frame, double half_width)
    : world_frame_(world_frame),
      half_width_(half_width),
      active_(make_marker(world_frame, "constraints", 0, Marker::TEXT_VIEW_FACING)) {
  active_.color = color(0.30, 0.10, 0.50);
}

void ConstraintMarkers::add(const DrawnImpulse& impulse) {
  if (impulses_.size() == max_impulses) impulses_.erase(impulses_.begin());
  const Vector3d change = impulse.next_velocity - impulse.velocity;
  const double speed = std::max(impulse.velocity.norm(), impulse.next_velocity.norm());
  const double size = change.norm();
  const double length = size > 0 ? half_width_ * std::clamp(12 * size / speed, 2.0, 8.0) : 0;
  const Vector3d tip = impulse.place + (size > 0 ? Vector3d(length / size * change) : Vector3d::Zero());
  Drawn drawn;
  drawn.arrow = make_marker(world_frame_, "impulses", 0, size > 0 ? Marker::ARROW : Marker::SPHERE);
  drawn.arrow.color = color(0.90, 0.05, 0.05);
  drawn.arrow.scale.x = 0.2 * half_width_;   // shaft
  drawn.arrow.scale.y = 0.45 * half_width_;  // head
  drawn.arrow.scale.z = 0.6 * half_width_;   // length of the head
  drawn.arrow.points = {point(impulse.place.x(), impulse.place.y(), impulse.place.z()),
                        point(tip.x(), tip.y(), tip.z())};
  if (size == 0) drawn.arrow.pose.position = drawn.arrow.points.front();
  drawn.label = make_marker(world_frame_, "impulse_constraints", 0, Marker::TEXT_VIEW_FACING);
  drawn.label.color = drawn.arrow.color;
  char text[40];
  std::snprintf(text, sizeof text, ": %.3g m/s", size);
  drawn.label.text = impulse.constraints + text;
  impulses_.push_back(drawn);
}

void ConstraintMarkers::clear() {
  cleared_ = std::max(cleared_, impulses_.size());
  impulses_.clear();
}

/// Beyond the tip of the arrow; farther up or down if another label, or the body, is there.
void ConstraintMarkers::place_label(Drawn& drawn, double size, const PictureBox& body) const {
  const Vector3d foot = vector_of(drawn.arrow.points.front());
  const Vector3d tip = vector_of(drawn.arrow.points.back());
  const Vector2d half = 0.5 * size * Vector2d(width_of(drawn.label.text), 1);
  const double side = tip.x() < foot.x() ? -1 : 1;
  const Vector3d first = tip + Vector3d(side * (half.x() + 0.5 * size), 0, 0);
  drawn.is_placed = false;
  constexpr int most = 40;  // half lines
  for (int i = 0; i < most && !drawn.is_placed; ++i) {
    const int lines = i % 2 == 1 ? (i + 1) / 2 : -i / 2;  // 0, 1, -1, 2, ...
    const Vector3d middle = first + Vector3d(0, 0.75 * lines * size, 0);
    drawn.box = {in_picture(middle), half};
    const auto meets = [&](const Drawn& other) {
      const bool is_label = &other != &drawn && other.is_placed && may_overlap(drawn.box, other.box);
      return is_label || may_overlap(drawn.box, in_picture(vector_of(other.arrow.points.front())),
                                     in_picture(vector_of(other.arrow.points.back())));
    };
    drawn.is_placed =
        !may_overlap(drawn.box, body) && std::none_of(impulses_.begin(), impulses_.end(), meets);
    drawn.label.pose.position = point(middle.x(), middle.y(), middle.z());
  }
  drawn.label.scale.z = size;
}

/// Over the body, or under it if a label of an impulse is there.
void ConstraintMarkers::write_active(visualization_msgs::MarkerArray& markers, const Vector3d& place,
                                     double size) {
  const Vector2d half = 0.5 * size * Vector2d(width_of(active_.text), 1);
  bool is_free = false;
  for (const double side : {1.0, -1.0}) {
    if (is_free) break;
    const Vector3d middle = place + Vector3d(0, side * (3 * half_width_ + 1.5 * size), 0);
    const PictureBox box{in_picture(middle), half};
    is_free = std::none_of(impulses_.begin(), impulses_.end(), [&box](const Drawn& other) {
      return other.is_placed && may_overlap(box, other.box);
    });
    active_.pose.position = point(middle.x(), middle.y(), middle.z());
  }
  active_.action = is_free ? Marker::ADD : Marker::DELETE;
  active_.scale.z = size;
  markers.markers.push_back(active_);
}

void ConstraintMarkers::append_to(visualization_msgs::MarkerArray& markers, const Vector3d& place,
                                  const std::string& active, double unit) {
  const double size = letter_size * unit;
  const PictureBox body{in_picture(place), Vector2d::Constant(2 * half_width_)};
  for (Drawn& drawn : impulses_) {
    if (!drawn.is_placed || may_overlap(drawn.box, body)) place_label(drawn, size, body);
  }
  for (std::size_t i = 0; i < std::max(cleared_, impulses_.size()); ++i) {
    const bool is_shown = i < impulses_.size();
    const auto id = static_cast<std::int32_t>(i);
    Marker arrow = is_shown ? impulses_[i].arrow : make_marker(world_frame_, "impulses", id, Marker::ARROW);
    Marker label =
        is_shown ? impulses_[i].label : make_marker(world_frame_, "impulse_constraints", id, Marker::ARROW);
    arrow.id = label.id = id;
    if (!is_shown) arrow.action = Marker::DELETE;
    if (!is_shown || !impulses_[i].is_placed) label.action = Marker::DELETE;
    markers.markers.push_back(arrow);
    markers.markers.push_back(label);
  }
  cleared_ = 0;
  active_.text = active;
  write_active(markers, place, size);
}

}  // namespace hybrid_sphere::ros_interface
