#pragma once

#include <atomic>

#include "hybrid_sphere/mechanics/solution.hpp"
#include "mechanics/segment.hpp"

namespace hybrid_sphere::mechanics {

/// The data of a Solution.
struct Solution::Record {
  Model model;
  std::vector<Segment> segments;  // never empty; ascending; at a switch the later one applies
  std::vector<Switch> switches;
  std::vector<std::uint64_t> applied;  // for each constraint
  Status status;
  Precision precision;
  Projection projection;
  Effort effort;
};

}  // namespace hybrid_sphere::mechanics
