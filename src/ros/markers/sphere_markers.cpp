#include "ros/markers/sphere_markers.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "ros/markers/ball_mesh.hpp"
#include "ros/markers/marker_tools.hpp"
#include "sphere/constants.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

using visualization_msgs::Marker;

constexpr std::size_t max_impulses = 50;

}  // namespace

SphereMarkers::SphereMarkers(const Frames& frames, const Sphere& sphere, const MarkerStyle& style)
    : frames_(frames),
      sphere_(sphere),
      style_(style),
      ball_(ball_markers(frames, sphere.radius())),
      slip_(frames, sphere.radius()),
      trail_(make_marker(frames.world, "trail", 0, Marker::LINE_STRIP)) {
  trail_.scale.x = 0.12 * sphere.radius();
  trail_.color = color(0.30, 0.10, 0.50);
  trail_.points.reserve(longest_trail() + 1);
  impulses_.reserve(max_impulses);
}

void SphereMarkers::set_style(const MarkerStyle& style) {
  style_ = style;
  shorten_trail(std::max<std::size_t>(longest_trail(), 1));  // the corner from which the sphere comes
}

/// @param corners  that stay, the newest ones, beside the sphere
void SphereMarkers::shorten_trail(std::size_t corners) {
  const std::size_t kept = std::min(trail_.points.size(), corners + 1);
  trail_.points.erase(trail_.points.begin(), trail_.points.end() - static_cast<std::ptrdiff_t>(kept));
}

// Many at a time, so that a corner is moved once on the average.
void SphereMarkers::add_to_trail(const Vector2d& position) {
  if (trail_.points.size() > longest_trail()) shorten_trail(longest_trail() / 2);
  trail_.points.back() = point(position.x(), position.y(), 0.5 * trail_.scale.x);
  trail_.points.push_back(trail_.points.back());
}

/// Its end follows the sphere; where the path bends or turns back, a corner is left.
void SphereMarkers::lead_trail(const Vector2d& position) {
  const double bend = 0.02 * sphere_.radius();  // that is not seen
  const auto& corner = trail_.points[trail_.points.size() - 2];
  const Vector2d end(trail_.points.back().x, trail_.points.back().y);
  const Vector2d before = end - Vector2d(corner.x, corner.y);
  const Vector2d now = position - end;
  const double across = std::abs(before.x() * now.y() - before.y() * now.x());
  // An arc leaves its chord by a quarter of chord times angle between chord and tangent.
  if (before.dot(now) < 0 || across > 4 * bend * now.norm()) add_to_trail(end);
  trail_.points.back().x = position.x();
  trail_.points.back().y = position.y();
}

void SphereMarkers::start_at(const Vector2d& position) {
  trail_.points.assign(1, geometry_msgs::Point());
  add_to_trail(position);
  for (const Impulse& impulse : impulses_) remove(impulse);
  impulses_.clear();
}

void SphereMarkers::remove(const Impulse& impulse) {
  if (impulse.sent) to_delete_.push_back(impulse.arrow.id);
}

void SphereMarkers::add(const Switch& event, const ros::Time& stamp) {
  add_to_trail(event.position);
  if (event.impulse.isZero(0)) return;
  if (impulses_.size() == max_impulses) {
    remove(impulses_.front());
    impulses_.erase(impulses_.begin());
  }
  impulses_.push_back(draw(event));
  Impulse& impulse = impulses_.back();
  impulse.arrow.id = impulse.label.id = next_id_;
  next_id_ = next_id_ < std::numeric_limits<std::int32_t>::max() ? next_id_ + 1 : 0;
  const bool is_last = stamp.sec + style_.impulse_lifetime >= ros::TIME_MAX.sec;
  impulse.until = is_last ? ros::TIME_MAX : stamp + ros::Duration(style_.impulse_lifetime);
}

/// The arrow shows P as a part of the momentum that the energy before the switch could make, in radii.
SphereMarkers::Impulse SphereMarkers::draw(const Switch& event) const {
  const double R = sphere_.radius();
  const double size = std::hypot(event.impulse.x(), event.impulse.y());
  const Vector2d direction = event.impulse / size;  // also of an impulse whose square is 0
  const double part = size / std::sqrt(2 * sphere_.mass() * event.energy_before);
  const double length = style_.arrow_scale * R * std::clamp(16 * part, 2.5, 8.0);
  const Vector2d tip = event.position + length * direction;
  Impulse impulse;
  impulse.arrow = make_marker(frames_.world, "impulses", 0, Marker::ARROW);
  impulse.arrow.color = color(0.90, 0.05, 0.05);
  impulse.arrow.scale.x = 0.2 * R;   // shaft
  impulse.arrow.scale.y = 0.45 * R;  // head
  impulse.arrow.scale.z = 0.6 * R;   // length of the head
  const double z = 0.25 * R;
  impulse.arrow.points = {point(event.position.x(), event.position.y(), z), point(tip.x(), tip.y(), z)};
  impulse.label = make_marker(frames_.world, "impulse_sizes", 0, Marker::TEXT_VIEW_FACING);
  impulse.label.color = impulse.arrow.color;
  impulse.tip = tip;
  impulse.along = direction;
  impulse.velocity = event.before.velocity;
  char text[40];
  std::snprintf(text, sizeof text, "|P| = %.3g N s", size);
  impulse.label.text = text;
  return impulse;
}

/// Whether a label meets neither the sphere, nor a name, nor an impulse or the way to it.
bool SphereMarkers::is_free(const PictureBox& box, const Impulse& own) const {
  const auto meets = [&box](const PictureBox& other) { return may_overlap(box, other); };
  if (std::any_of(obstacles_.begin(), obstacles_.end(), meets)) return false;
  const auto meets_impulse = [&](const Impulse& other) {
    const auto& ends = other.arrow.points;
    const Vector2d foot(ends.front().x, ends.front().y);
    const bool is_other = other.arrow.id != own.arrow.id;
    return (is_other && other.sent && other.has_label && meets(other.box)) ||
           may_overlap(box, in_picture(foot, ends.front().z), in_picture(other.tip, ends.front().z));
  };
  if (meets_impulse(own) || std::any_of(impulses_.begin(), impulses_.end(), meets_impulse)) return false;
  const auto& foot = own.arrow.points.front();
  const Vector2d place(foot.x, foot.y);
  return !may_overlap(box, in_picture(place, 0), in_picture(place - own.velocity, 0));
}

/// Beyond the tip of the arrow or, where the sphere has come from there, beside the arrow; farther up or down
/// if there is something already. Without a free place there is no label.
void SphereMarkers::place_label(Impulse& impulse, double unit) const {
  const double R = sphere_.radius();
  const double size = std::max(0.5 * R, 0.022 * unit);
  const double height = std::max(0.6 * R, 0.7 * size);
  const Vector2d half = 0.5 * size * Vector2d(width_of(impulse.label.text), 1);
  const double speed = impulse.velocity.norm();
  const bool lies_on_path = -impulse.velocity.dot(impulse.along) > 0.8 * speed;
  Vector2d away = impulse.along;
  Vector2d from = impulse.tip;
  if (lies_on_path) {
    away = turned(impulse.along);
    const double side = away.dot(impulse.velocity);
    const bool is_on_line = std::abs(side) < 1e-6 * speed;
    if (is_on_line ? away.y() < 0 : side < 0) away = -away;
    const geometry_msgs::Point& foot = impulse.arrow.points.front();
    from = 0.5 * (from + Vector2d(foot.x, foot.y));
  }
  const Vector2d first = from + (0.5 * size + half.dot(away.cwiseAbs())) * away;
  const double upward = away.y() < 0 ? -1 : 1;
  constexpr int most = 40;  // half lines
  impulse.has_label = false;
  for (int i = 0; i < most && !impulse.has_label; ++i) {
    const int lines = i % 2 == 1 ? (i + 1) / 2 : -i / 2;  // 0, 1, -1, 2, ...
    const Vector2d middle = first + Vector2d(0, upward * lines * 0.75 * size);
    impulse.box = {in_picture(middle, height), half};
    impulse.has_label = is_free(impulse.box, impulse);
    impulse.label.pose.position = point(middle.x(), middle.y(), height);
  }
  impulse.label.scale.z = size;
}

const visualization_msgs::MarkerArray& SphereMarkers::update(const State& state, const ros::Time& stamp,
                                                             bool all, double unit,
                                                             const std::vector<RegionName>& names) {
  update_.markers.clear();
  for (const std::int32_t id : to_delete_) {
    for (const char* name : {"impulses", "impulse_sizes"}) {
      update_.markers.push_back(make_marker(frames_.world, name, id, Marker::ARROW));
      update_.markers.back().action = Marker::DELETE;
    }
  }
  to_delete_.clear();
  lead_trail(state.position);
  update_.markers.push_back(trail_);
  if (longest_trail() == 0) update_.markers.back().action = Marker::DELETE;
  slip_.add_to(update_, state, all);
  impulses_.erase(std::remove_if(impulses_.begin(), impulses_.end(),
                                 [&](const Impulse& impulse) { return impulse.until <= stamp; }),
                  impulses_.end());
  if (std::exchange(unit_, unit) != unit) {
    for (Impulse& impulse : impulses_) impulse.sent = false;
  }
  const double R = sphere_.radius();
  obstacles_.assign(1, {in_picture(state.position, R), Vector2d::Constant(R)});
  for (const RegionName& name : names)
    obstacles_.push_back({in_picture(name.middle, 0.7 * name.size), name.half()});
  for (Impulse& impulse : impulses_) {
    const bool is_in_the_way =
        impulse.sent && impulse.has_label &&
        std::any_of(obstacles_.begin(), obstacles_.end(),
                    [&](const PictureBox& other) { return may_overlap(impulse.box, other); });
    if (!impulse.sent || is_in_the_way || (all && !impulse.has_label)) place_label(impulse, unit);
    if (!impulse.sent || is_in_the_way || all) push(impulse, stamp);
  }
  return update_;
}

void SphereMarkers::push(Impulse& impulse, const ros::Time& stamp) {
  impulse.sent = true;
  impulse.arrow.lifetime = impulse.label.lifetime = impulse.until - stamp;
  impulse.label.action = impulse.has_label ? Marker::ADD : Marker::DELETE;
  update_.markers.push_back(impulse.arrow);
  update_.markers.push_back(impulse.label);
}

}  // namespace hybrid_sphere::ros_interface
