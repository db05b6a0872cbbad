#pragma once

#include "hybrid_sphere/scene/scene.hpp"

namespace hybrid_sphere::testing {

/// Ground that moves.
inline scene::Material belt(const Vector2d& velocity, scene::Law law = scene::Law::rough) {
  scene::Material material(law);
  material.belt = velocity;
  return material;
}

inline scene::Material coulomb(double friction) {
  scene::Material material(scene::Law::coulomb);
  material.friction = friction;
  return material;
}

}  // namespace hybrid_sphere::testing
