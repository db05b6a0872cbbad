#pragma once

#include "hybrid_sphere/scene/scene.hpp"

namespace hybrid_sphere {

/// Velocity of the centre [m/s] and omega on the fixed axes of the world frame [rad/s].
/// @code
/// const Twist rolling{{1, 0}, {0, 1 / 0.5, 0}};  // a sphere of radius 0.5 m to the right
/// @endcode
struct Twist {
  Vector2d velocity = Vector2d::Zero();
  Vector3d angular_velocity = Vector3d::Zero();
};

}  // namespace hybrid_sphere
