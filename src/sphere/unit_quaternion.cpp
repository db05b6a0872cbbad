#include "sphere/unit_quaternion.hpp"

namespace hybrid_sphere {

void normalize(Quaterniond& q) { q.coeffs().stableNormalize(); }

Quaterniond normalized(const Quaterniond& q) { return q.normalized(); }

}  // namespace hybrid_sphere
