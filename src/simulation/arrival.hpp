#pragma once

#include <optional>

#include "hybrid_sphere/simulation/records.hpp"
#include "simulation/segment.hpp"

namespace hybrid_sphere {

/// The sphere where something may change, before it does.
struct Arrival {
  double tau = 0;          ///< since the beginning of the segment [s]
  Segment::Start state{};  ///< at that time
  Cause cause = Cause::placed;
  std::optional<ContactMode> mode{};  ///< known beforehand
  bool restarts = false;              ///< the motion has ended and cannot continue
  bool complete = false;              ///< the orientation and the contacts are those of this instant
  double tau_remainder = 0;           ///< part of the instant lost by rounding tau [s]
  bool struck = false;                ///< no constraint holds any more, not even the one in force
};

}  // namespace hybrid_sphere
