#pragma once

#include "hybrid_sphere/export.hpp"
#include "hybrid_sphere/mechanics/solution.hpp"

namespace hybrid_sphere::mechanics {

/// Small motions about a steady one, dx = vector e^(eigenvalue t) with x = (q, v), in all directions that the
/// constraints leave free.
struct Modes {
  /// By descending real part; of a conjugate pair, the one with a positive imaginary part is first (k) [1/s].
  Eigen::VectorXcd eigenvalues;
  /// dx of each (N + n, k), of length 1; where coordinates turn with a body, at the present instant.
  Eigen::MatrixXcd vectors;
  /// How many directions are left out because their eigenvalue is 0: along cyclic coordinates, as the place
  /// and the heading of a bicycle, and to a neighbouring steady motion, as at another speed.
  Index neutral = 0;
};

/// Modes of the equations of motion at a state of rest or of a steady motion, under the constraints that hold
/// there: eigenvalues of the linear equations on the positions and velocities that satisfy them.
///
/// Steady are motions at constant v, and those of a MultibodySystem that, seen from axes which turn at a
/// constant rate, are constant but for bodies that spin about an axis of symmetry: a bicycle that runs
/// straight ahead or in a circle. Neither L nor the constraints may depend on the time.
/// An eigenvalue is 0 if it is below about 1e-4 of the largest one.
///
/// Throws std::invalid_argument for a state of another size, or one that is not steady, with the acceleration
/// that is left; otherwise as linearize().
/// Source: docs/theory.md 7.1, linearized.
/// @code
/// const auto is_stable = [](const mechanics::Model& model, const mechanics::State& state) {
///   const mechanics::Modes modes = mechanics::modes(model, state);
///   return modes.eigenvalues.size() == 0 || modes.eigenvalues[0].real() <= 0;
/// };
/// @endcode
HYBRID_SPHERE_EXPORT Modes modes(const Model& model, const State& state);

}  // namespace hybrid_sphere::mechanics
