#pragma once

#include <optional>

#include "hybrid_sphere/simulation/records.hpp"
#include "hybrid_sphere/simulation/segment.hpp"

namespace hybrid_sphere {

/// A time as an unevaluated sum, so that segments can be strung together without loss.
struct SplitTime {
  double value = 0;
  double remainder = 0;
  SplitTime plus(double tau, double tau_remainder = 0) const {
    const double sum = value + tau;
    const double back = sum - value;
    const double lost = (value - (sum - back)) + (tau - back);
    const double small = remainder + lost + tau_remainder;
    const double rounded = sum + small;
    return {rounded, small - (rounded - sum)};
  }
  /// 0 at the time next to it: what is said to be at the instant is at it.
  double until(double time) const { return time == value ? 0 : (time - value) - remainder; }
};

/// The sphere where something may change, before it does.
struct Arrival {
  double tau = 0;          ///< since the beginning of the segment [s]
  Segment::Start state{};  ///< at that time
  Cause cause = Cause::placed;
  std::optional<ContactMode> mode{};  ///< known beforehand
  bool restarts = false;              ///< the motion has ended, so that none goes on
  bool complete = false;              ///< the orientation and the contacts are those of this instant
  double tau_remainder = 0;           ///< what tau leaves out [s]
  bool struck = false;                ///< no constraint holds any more, the one in force neither
};

}  // namespace hybrid_sphere
