#pragma once

#include "support/recorded.hpp"
#include "verdict.hpp"

namespace hybrid_sphere::fuzz {

/// A run, and the longest time in it after which it asked whether to go on [s of processor time].
struct Run {
  testing::Record record;
  double silence = 0;
};

/// Runs a scene, and interrupts it after as long as its case allows.
Run run_for(const Case& a_case, const scene::Scene& scene, int outputs);

/// Whether a node that does this run answers in time, whatever it computes.
bool asks_often(const Case& a_case, const Run& run);

/// Of a run that was interrupted: it has come among many switches; or its method was asked for, its steps are
/// what took the time, and `auto` comes to an end.
Verdict judge_interrupted(const Case& a_case, scene::Scene scene, const testing::Record& run);

/// Whether a run goes through a region in so little time that rounding may take both edges for one (a sliver,
/// or sides of several regions on one line): instants of a curved path whose error bounds overlap are one.
/// @param run   with `switches`
/// @param span  of the run [s]
template <class Run>
bool passes_in_no_time(const Run& run, double span) {
  const auto& events = run.switches;
  for (std::size_t i = 0; i + 1 < events.size(); ++i) {
    const auto stay = static_cast<double>(events[i + 1].time - events[i].time);
    if (stay > 0 && stay <= 0x1p-40 * span && events[i].to != events[i + 1].to) return true;
  }
  return false;
}

}  // namespace hybrid_sphere::fuzz
