#pragma once

#include <hybrid_sphere/SetInitialState.h>

#include "hybrid_sphere/scene/scene.hpp"
#include "hybrid_sphere/scene/scene_error.hpp"

namespace hybrid_sphere::ros_interface {

/// The initial state that a request stands for, validated as one of a scene file; paths of errors begin with
/// "initial_state". The height of the centre is 0 or the radius, an all-zero quaternion is the identity, the
/// velocity is horizontal.
/// @param radius  of the sphere [m]
/// @throws scene::SceneError  with the path, the value and what is allowed
scene::InitialState initial_state_from_message(const SetInitialState::Request& request, double radius);

}  // namespace hybrid_sphere::ros_interface
