#include "ros/conversions/initial_state_message.hpp"

#include "ros/conversions/world_coordinates.hpp"
#include "scene/check.hpp"

namespace hybrid_sphere::ros_interface {

scene::InitialState initial_state_from_message(const SetInitialState::Request& request,
                                               const Eigen::Isometry3d& to_world, double radius) {
  const Vector3d center = point_in_world(request.pose.position, to_world);
  check_height(center.z(), to_world, radius, "initial_state.position[2]");
  scene::InitialState state;
  state.position = center.head<2>();
  state.velocity = horizontal_in_world(request.twist.linear, to_world, "initial_state.velocity[2]",
                                       "0: the sphere stays on the ground [m/s]");
  state.angular_velocity = vector_in_world(request.twist.angular, to_world);
  state.orientation = orientation_in_world(request.pose.orientation, to_world);
  scene::check_initial_state(state, "initial_state");
  state.orientation.normalize();
  return state;
}

}  // namespace hybrid_sphere::ros_interface
