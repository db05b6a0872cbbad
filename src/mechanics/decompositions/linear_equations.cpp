#include "mechanics/decompositions/linear_equations.hpp"

#include <Eigen/LU>

namespace hybrid_sphere::mechanics {

Vector solve_linear_equations(const Matrix& a, const Vector& b) { return a.partialPivLu().solve(b); }

}  // namespace hybrid_sphere::mechanics
