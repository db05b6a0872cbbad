#pragma once

#include <cfloat>
#include <cmath>

#include "geometry/vectors.hpp"
#include "hybrid_sphere/sphere/twist.hpp"

namespace hybrid_sphere {

/// Divides by the norm, which may be of any size.
void normalize(Quaterniond& q);
/// The quotient by the norm, whose square is a normal number.
Quaterniond normalized(const Quaterniond& q);

/// The unit quaternion of the same rotation; the same to the bit where q is one to rounding.
/// @param q  finite, not 0
inline Quaterniond to_unit(Quaterniond q) {
  if (!(std::abs(q.squaredNorm() - 1) <= 4 * DBL_EPSILON)) normalize(q);
  return q;
}

/// The same, to rounding and without a root where |q| is 1 to 1e-8.
inline Quaterniond near_unit(const Quaterniond& q) {
  const double excess = q.squaredNorm() - 1;
  if (std::abs(excess) > 1e-8) return normalized(q);
  return Quaterniond(Eigen::Vector4d((1 - 0.5 * excess) * q.coeffs()));
}

}  // namespace hybrid_sphere
