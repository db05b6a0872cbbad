#pragma once

#include "hybrid_sphere/export.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"

namespace hybrid_sphere::mechanics {

/// Finds a state at rest near a guess: positions q at which the accelerations v' under the constraints that
/// hold are 0, and the constraints on positions are satisfied. Velocities that are not 0 are kept, if the
/// constraints allow: then this is a steady motion, as that of a conical pendulum.
///
/// Newton's method with a line search: positions move in directions that the constraints leave free, and of
/// those only where accelerations depend on them, so that a cyclic coordinate keeps its value. The time is
/// that of the guess. Constraints may say the same twice.
/// @param guess  its `active` constraints hold in the result; by default those that hold, or slide, at the
///               guess. Positions and velocities need not satisfy them exactly
/// @return  the state, with v' = 0 to round-off, and the multipliers that hold it there
/// Throws std::invalid_argument where solve() does, and NumericalError with the number of iterations and the
/// residual if the method does not converge, or with the constraints that do not hold there: a contact that
/// would lift off, a friction that would slide.
/// @code
/// const auto hanging = [](const mechanics::Model& pendulum) {
///   return mechanics::equilibrium(pendulum, {0, {0.3}, {0}}).q[0];
/// };
/// @endcode
HYBRID_SPHERE_EXPORT State equilibrium(const Model& model, const Initial& guess);

}  // namespace hybrid_sphere::mechanics
