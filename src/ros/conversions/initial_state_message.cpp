#include "ros/conversions/initial_state_message.hpp"

#include "scene/check.hpp"
#include "scene/tree.hpp"

namespace hybrid_sphere::ros_interface {

using scene::SceneError;
using scene::Tree;

scene::InitialState initial_state_from_message(const SetInitialState::Request& request, double radius) {
  const auto& p = request.pose.position;
  const auto& q = request.pose.orientation;
  const auto& v = request.twist.linear;
  const auto& w = request.twist.angular;
  if (p.z != 0 && p.z != radius) {
    throw SceneError("initial_state.position[2]", Tree(p.z).describe(),
                     "0, or the radius " + Tree(radius).describe() + " [m]");
  }
  if (v.z != 0) {
    throw SceneError("initial_state.velocity[2]", Tree(v.z).describe(),
                     "0: the sphere stays on the ground [m/s]");
  }
  scene::InitialState state;
  state.position = {p.x, p.y};
  state.velocity = {v.x, v.y};
  state.angular_velocity = {w.x, w.y, w.z};
  if (q.x != 0 || q.y != 0 || q.z != 0 || q.w != 0) state.orientation = Quaterniond(q.w, q.x, q.y, q.z);
  scene::check_initial_state(state, "initial_state");
  state.orientation.normalize();
  return state;
}

}  // namespace hybrid_sphere::ros_interface
