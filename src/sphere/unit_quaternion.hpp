#pragma once

#include <cfloat>
#include <cmath>

#include "hybrid_sphere/sphere/twist.hpp"

namespace hybrid_sphere {

/// The unit quaternion of the same rotation; the same to the bit where q is one to rounding.
/// @param q  finite, not 0
inline Quaterniond to_unit(Quaterniond q) {
  if (!(std::abs(q.squaredNorm() - 1) <= 4 * DBL_EPSILON)) q.coeffs().stableNormalize();
  return q;
}

}  // namespace hybrid_sphere
