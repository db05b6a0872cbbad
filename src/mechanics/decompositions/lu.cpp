#include "mechanics/decompositions/lu.hpp"

namespace hybrid_sphere::mechanics {

ComplexLu::ComplexLu(const Eigen::MatrixXcd& a) : lu_(a) {}

Eigen::VectorXcd ComplexLu::solve(const Eigen::VectorXcd& b) const { return lu_.solve(b); }

Vector solve_linear_equations(const Matrix& a, const Vector& b) { return a.partialPivLu().solve(b); }

}  // namespace hybrid_sphere::mechanics
