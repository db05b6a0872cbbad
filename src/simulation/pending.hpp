#pragma once

#include "hybrid_sphere/simulation/records.hpp"

namespace hybrid_sphere {

/// What has come from outside and acts at the next instant.
struct Pending {
  bool placed = true;                ///< the ground under the sphere has yet to act
  Cause cause = Cause::placed;       ///< why
  bool new_forces = false;           ///< or another accuracy
  Vector2d kick = Vector2d::Zero();  ///< change of the velocity [m/s]
};

}  // namespace hybrid_sphere
