#pragma once

#include "geometry/double_double.hpp"

namespace hybrid_sphere {

/// A time as an unevaluated sum, so that segments can be chained without loss.
struct SplitTime {
  double value = 0;
  double remainder = 0;
  SplitTime plus(double tau, double tau_remainder = 0) const {
    const exact::DoubleDouble sum = exact::two_sum(value, tau);
    const double small = remainder + sum.remainder + tau_remainder;
    const double rounded = sum.value + small;
    return {rounded, small - (rounded - sum.value)};
  }
  /// 0 at the nearest binary64 time, which counts as the instant itself.
  double until(double time) const { return time == value ? 0 : (time - value) - remainder; }
};

}  // namespace hybrid_sphere
