#pragma once

#include <cstdint>
#include <map>
#include <ostream>
#include <string>
#include <vector>

#include "verdict.hpp"

namespace hybrid_sphere::fuzz {

/// Scenes number first, first + 1 ... of a seed, judged in processes of their own, so that a crash and a
/// scene that takes too long are findings like others.
struct Campaign {
  std::uint64_t seed = 1;
  std::uint64_t first = 0;
  std::uint64_t scenes = 10000;
  double seconds = 0;     ///< of wall time, after which no scene is begun; 0: no limit
  double cpu_limit = 60;  ///< of a scene [s of processor time]
  int processes = 1;
  bool hostile = false;
  bool shrink = true;
  std::vector<Character> characters;
  Judge judge;
  std::string directory;  ///< where the scenes of findings are kept; empty: nowhere
};

struct Tally {
  std::uint64_t scenes = 0;
  std::map<char, std::uint64_t> kinds;           ///< by Verdict::Kind
  std::map<std::string, std::uint64_t> reasons;  ///< of halts
  std::map<std::string, std::uint64_t> refusals;
  std::map<std::string, std::uint64_t> skips;     ///< why a scene says nothing
  std::map<std::string, std::uint64_t> findings;  ///< by claim
  double seconds = 0;
};

/// The scene of a number, and its character's name.
Case case_of(const Campaign& campaign, std::uint64_t number, std::string* character = nullptr);

/// Judges in a process of its own, under the CPU limit.
Verdict judge_apart(const Campaign& campaign, const Case& a_case);

/// The smallest scene found that breaks the same claim.
Case shrink(const Campaign& campaign, const Case& a_case, const std::string& claim);

/// Runs it, and prints each finding with its seed, number and minimal scene: the first three of a claim.
Tally run(const Campaign& campaign, std::ostream& out);

}  // namespace hybrid_sphere::fuzz
