#include "ros/conversions/conversions.hpp"

#include <cmath>

#include "scene/ranges.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

/// A number as it is sent: what is smaller than a state may have is 0, so that every state that is sent may
/// be set.
double sent(double number) {
  return std::abs(number) < scene::least_size ? std::copysign(0., number) : number;
}

template <class Message>
void fill_xyz(double x, double y, double z, Message& message) {
  message.x = sent(x);
  message.y = sent(y);
  message.z = sent(z);
}

void fill_quaternion(const Quaterniond& q, geometry_msgs::Quaternion& message) {
  message.x = q.x();
  message.y = q.y();
  message.z = q.z();
  message.w = q.w();
}

}  // namespace

void fill(const State& state, double radius, geometry_msgs::Pose& pose) {
  fill_xyz(state.position.x(), state.position.y(), radius, pose.position);
  fill_quaternion(state.orientation, pose.orientation);
}

void fill(const State& state, double radius, geometry_msgs::Transform& transform) {
  fill_xyz(state.position.x(), state.position.y(), radius, transform.translation);
  fill_quaternion(state.orientation, transform.rotation);
}

void fill(const Vector3d& origin, geometry_msgs::Transform& transform) {
  fill_xyz(origin.x(), origin.y(), origin.z(), transform.translation);
  transform.rotation.x = transform.rotation.y = transform.rotation.z = 0;
  transform.rotation.w = 1;
}

void fill(const Twist& twist, geometry_msgs::Twist& message) {
  const Vector3d& w = twist.angular_velocity;
  fill_xyz(twist.velocity.x(), twist.velocity.y(), 0, message.linear);
  fill_xyz(w.x(), w.y(), w.z(), message.angular);
}

void fill_in_sphere_frame(const State& state, geometry_msgs::Twist& message) {
  const Quaterniond to_sphere = state.orientation.conjugate();
  const Vector2d& v_W = state.twist.velocity;
  const Vector3d v_S = to_sphere * Vector3d(v_W.x(), v_W.y(), 0);
  const Vector3d w_S = to_sphere * state.twist.angular_velocity;
  fill_xyz(v_S.x(), v_S.y(), v_S.z(), message.linear);
  fill_xyz(w_S.x(), w_S.y(), w_S.z(), message.angular);
}

void fill(const State& state, const Vector3d& reaction, const Sphere& sphere, SphereState& message) {
  message.time = state.time;
  message.stage = static_cast<std::uint8_t>(state.stage);
  message.mode = to_string(state.mode);
  message.region.assign(state.region);
  fill(state, sphere.radius(), message.pose);
  fill(state.twist, message.twist);
  fill_xyz(state.slip.x(), state.slip.y(), 0, message.slip);
  fill_xyz(reaction.x(), reaction.y(), reaction.z(), message.reaction);
  message.kinetic_energy = sphere.kinetic_energy(state.twist);
}

void fill(const Switch& event, double radius, ConstraintSwitch& message) {
  message.index = event.index;
  message.time = event.time;
  message.kind = static_cast<std::uint8_t>(event.kind);
  message.cause = static_cast<std::uint8_t>(event.cause);
  message.from_stage = static_cast<std::uint8_t>(event.from_stage);
  message.to_stage = static_cast<std::uint8_t>(event.to_stage);
  message.from_region.assign(event.from_region);
  message.to_region.assign(event.to_region);
  fill_xyz(event.position.x(), event.position.y(), radius, message.position);
  fill_xyz(event.slip_before.x(), event.slip_before.y(), 0, message.slip_before);
  fill_xyz(event.impulse.x(), event.impulse.y(), 0, message.impulse);
  const Vector3d& L = event.angular_impulse;
  fill_xyz(L.x(), L.y(), L.z(), message.angular_impulse);
  fill(event.before, message.twist_before);
  fill(event.after, message.twist_after);
  message.energy_before = event.energy_before;
  message.energy_after = event.energy_after;
}

}  // namespace hybrid_sphere::ros_interface
