#pragma once

#include <string>
#include <vector>

#include "hybrid_sphere/scene/scene.hpp"

/// Generated scenes, each of a character that a kind of fault needs. All are made of testing::integer.
namespace hybrid_sphere::fuzz {

struct Case {
  scene::Scene scene{};
  double duration = 8;  ///< [s]
  bool patient = true;  ///< false: it is interrupted where it takes more steps than anybody waits for
};

struct Character {
  const char* name;
  const char* what;
  Case (*make)();
};

const std::vector<Character>& characters();

/// A scene of a character, by one of the methods: mostly `auto`.
Case make_case(const Character& character);

/// Replaces some of the numbers by ones at the ends of their ranges, or near them.
void make_hostile(Case& a_case);

}  // namespace hybrid_sphere::fuzz
