#pragma once

#include "hybrid_sphere/export.hpp"
#include "hybrid_sphere/mechanics/plant.hpp"

namespace hybrid_sphere::mechanics {

/// The equations of motion near a state, under the constraints that hold there: with x = (q, v),
///   x' = rate + A dx + B du.
/// Off the constraints they are (9)-(10) differentiated once, C v' = gamma, so that A has an eigenvalue 0 for
/// each constraint besides those of the motion.
struct Linearization {
  Vector rate;  ///< x' at the state (N + n)
  Matrix A;     ///< dx'/dx (N + n, N + n)
  Matrix B;     ///< dx'/du (N + n, number of inputs); no columns without an input
};

/// Derivatives by Ridders' extrapolated differences, over steps from an eighth of each component, or of 1,
/// down to 1e-13 of that: where forces are smooth, to some 1e-11 of the sizes of their terms. Throws
/// ConstraintError and NotFinite, std::invalid_argument for a state or an input of another size or with
/// numbers that are not finite, and std::out_of_range for an index that is not one of a constraint.
/// @code
/// const auto growth = [](const mechanics::Model& model, const mechanics::State& state) {
///   return mechanics::linearize(model, state).A.trace();  // the sum of the eigenvalues [1/s]
/// };
/// @endcode
HYBRID_SPHERE_EXPORT Linearization linearize(const Model& model, const State& state);
/// The same with B, at an input.
HYBRID_SPHERE_EXPORT Linearization linearize(const ModelOfInput& model, const Vector& input,
                                             const State& state);

}  // namespace hybrid_sphere::mechanics
