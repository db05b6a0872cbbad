#pragma once

#include "hybrid_sphere/scene/scene.hpp"

namespace hybrid_sphere {

/// Velocity of the centre [m/s] and omega on the fixed axes of the world frame [rad/s].
struct Twist {
  Vector2d velocity = Vector2d::Zero();
  Vector3d angular_velocity = Vector3d::Zero();
};

}  // namespace hybrid_sphere
