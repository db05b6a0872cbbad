#include "mechanics/decompositions/complex_lu.hpp"

namespace hybrid_sphere::mechanics {

ComplexLu::ComplexLu(const Eigen::MatrixXcd& a) : lu_(a) {}

Eigen::VectorXcd ComplexLu::solve(const Eigen::VectorXcd& b) const { return lu_.solve(b); }

}  // namespace hybrid_sphere::mechanics
