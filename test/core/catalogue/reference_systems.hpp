#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "catalogue/catalogue.hpp"

namespace hybrid_sphere::mechanics::catalogue::testing {

struct ReferenceState {
  double time = 0;
  int stage = 1;
  Vector q;
  Vector v;
  Vector multipliers;  ///< of zero size in stage 1
};

struct ReferenceImpulse {
  Vector q;
  Vector v_before;
  Vector v_after;
  Vector multipliers;
  Vector impulse;
  double kinetic_energy_before = 0;
  double kinetic_energy_after = 0;
};

/// A system of test/data/mechanics/general_systems.json, whose solution has 30 digits, as an entry of the
/// catalogue.
struct ReferenceSystem {
  std::string name;   ///< in the file
  std::string entry;  ///< in the catalogue
  Example example;    ///< with the file's numbers
  double t_switch = 0;
  ReferenceImpulse impulse;
  std::vector<ReferenceState> states;

  double duration() const { return states.back().time; }
};
std::ostream& operator<<(std::ostream& stream, const ReferenceSystem& system);

/// All systems of both files. Throws std::runtime_error for one that no entry of the catalogue stands for, or
/// with a number that its entry does not have.
const std::vector<ReferenceSystem>& reference_systems();

}  // namespace hybrid_sphere::mechanics::catalogue::testing
