#pragma once

#include <vector>

#include "hybrid_sphere/mechanics/model.hpp"

namespace hybrid_sphere::mechanics {

/// Velocities that satisfy the constraints which have held since before t; of those the ones of least kinetic
/// energy with the same numbers as `v` where it is given.
/// A constraint is not satisfied if it is off by more than the default accuracy: see relative_velocity.
/// @param given  which components of v are kept (n)
/// Throws std::invalid_argument with the constraint that is not satisfied, and NotFinite.
Vector consistent_velocities(const Model& model, double t, const Vector& q, const Vector& v,
                             const std::vector<bool>& given);

}  // namespace hybrid_sphere::mechanics
