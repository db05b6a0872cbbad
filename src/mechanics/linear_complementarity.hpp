#pragma once

#include <optional>

#include "hybrid_sphere/mechanics/equations_of_motion.hpp"

namespace hybrid_sphere::mechanics {

/// Solves w = A z + b, w >= 0, z >= 0, w.z = 0 by Lemke's method with lexicographic pivots, which ends for
/// any b. For copositive-plus A it finds a solution if there is one; for others, as those of contacts with
/// much friction, it may end without. Source: Cottle, Pang, Stone, The Linear Complementarity Problem, 4.4.
/// @param A  (k x k), k at most a few dozen, with entries of a similar size
/// @return   z (k); none where Lemke's path ends on a ray
std::optional<Vector> solve_complementarity(const Matrix& A, const Vector& b);

}  // namespace hybrid_sphere::mechanics
