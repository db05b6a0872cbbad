#pragma once

#include <string>
#include <vector>

#include "hybrid_sphere/mechanics/solution.hpp"
#include "random_systems.hpp"

namespace hybrid_sphere::fuzz {

/// The end of a random system, and its faults.
struct SystemVerdict {
  mechanics::Status status;
  std::size_t switches = 0;
  std::vector<std::string> faults;  ///< claims that do not hold; empty: all hold
};

/// Contacts push and do not pull, frictions stay within their cones, gaps do not become negative, no energy
/// is made and, where nothing dissipates it, none is lost between switches; each event occurs once for each
/// change of its sign.
SystemVerdict judge_laws(const RandomSystem& random);

/// A plant moves in any periods as in one, to the bit, and moves on from where it was saved: two that are put
/// back alike to the bit, and as the one that was saved.
SystemVerdict judge_plant(const RandomSystem& random);

/// In units that are powers of 4 of others the motion is the same up to rounding.
SystemVerdict judge_units(const RandomSystem& random);

}  // namespace hybrid_sphere::fuzz
