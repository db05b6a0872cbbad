#include "mechanics/decompositions/least_norm.hpp"

namespace hybrid_sphere::mechanics {

LeastNorm::LeastNorm(const Matrix& a) : decomposition_(a) {}

Vector LeastNorm::solve(const Vector& b) const { return decomposition_.solve(b); }

}  // namespace hybrid_sphere::mechanics
