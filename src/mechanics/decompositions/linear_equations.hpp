#pragma once

#include "hybrid_sphere/mechanics/equations_of_motion.hpp"

namespace hybrid_sphere::mechanics {

/// Returns the x (n) with A x = b, for a regular matrix A (n x n).
Vector solve_linear_equations(const Matrix& a, const Vector& b);

}  // namespace hybrid_sphere::mechanics
