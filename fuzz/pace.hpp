#pragma once

#include <cstdint>

#include "support/recorded.hpp"
#include "verdict.hpp"

namespace hybrid_sphere::fuzz {

/// A run, and how it asked whether to go on.
struct Run {
  testing::Record record;
  double silence = 0;      ///< the longest time after which it did [s of processor time]
  std::uint64_t deaf = 0;  ///< the most interruption points between where nobody is asked, in blocks of 256
};

/// Runs a scene, and interrupts it after as long as its case allows.
Run run_for(const Case& a_case, const scene::Scene& scene, int outputs);

/// Whether a node that does this run answers in time, whatever it computes.
bool asks_often(const Case& a_case, const Run& run);

/// Of a run that was interrupted: it has come among many switches; or its method was asked for, its steps are
/// what took the time, and `auto` comes to an end.
Verdict judge_interrupted(const Case& a_case, scene::Scene scene, const testing::Record& run);

}  // namespace hybrid_sphere::fuzz
