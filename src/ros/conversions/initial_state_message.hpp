#pragma once

#include <hybrid_sphere/SetInitialState.h>

#include <Eigen/Geometry>

#include "hybrid_sphere/scene/scene.hpp"
#include "hybrid_sphere/scene/scene_error.hpp"

namespace hybrid_sphere::ros_interface {

/// The initial state that a request stands for, validated as one of a scene file; paths of errors begin with
/// "initial_state". In the world the height of the centre is 0 or the radius and the velocity is horizontal;
/// an all-zero quaternion is the identity. The header is not looked at.
/// @param to_world  takes coordinates of the request's frame to those of the world frame
/// @param radius    of the sphere [m]
/// @throws scene::SceneError  with the path, the value and what is allowed
scene::InitialState initial_state_from_message(const SetInitialState::Request& request,
                                               const Eigen::Isometry3d& to_world, double radius);

}  // namespace hybrid_sphere::ros_interface
