#include "pace.hpp"
#include "interrupt/interrupt.hpp"

#include <algorithm>
#include <ctime>
#include <sstream>
#include <utility>

namespace hybrid_sphere::fuzz {
namespace {

using testing::Record;

/// How long a run may take [s of processor time]. A method that somebody asks for may take millions of steps
/// where `auto` would take another, and of the ends of the ranges nobody waits for the end.
double patience(const Case& a_case, const scene::Solver& solver) {
  if (!a_case.patient) return 0.5;
  return solver.uses_closed_forms() ? 8 : 2;
}

/// Whether the clock comes less and less far while the number of switches doubles: between edges that nearly
/// touch a million of them are passed before a cusp is told from a neck.
bool accumulates(const Record& run) {
  constexpr std::size_t many = 1 << 14;
  const std::size_t n = run.switches.size();
  if (n < many) return false;
  const auto time = [&](std::size_t i) { return run.switches[i - 1].time; };
  return time(n) - time(n / 2) < 0.75 * (time(n / 2) - time(n / 4)) &&
         time(n / 2) - time(n / 4) < 0.75 * (time(n / 4) - time(n / 8));
}

/// Whether it takes its switches quickly and would come to the end in a hundred millions of them, at the pace
/// of the latter half: the sphere is thrown to and fro between the edges of a strip along which it moves on.
bool gets_on_quickly(const Record& run, double seconds, double until) {
  constexpr std::size_t many = 1 << 14;
  constexpr double most = 1e8;
  constexpr double of_a_switch = 2e-4;  // [s of processor time]
  const std::size_t n = run.switches.size();
  if (n < many || seconds > of_a_switch * static_cast<double>(n)) return false;
  const double end = run.switches.back().time;
  const std::size_t half = n / 2;
  const double pace = (end - run.switches[half].time) / static_cast<double>(n - half);  // [s] for each
  return until - end < most * pace;
}

}  // namespace

Run run_for(const Case& a_case, const scene::Scene& scene, int outputs) {
  const double seconds = patience(a_case, scene.solver);
  const auto now = [] { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
  const double begin = now();
  double last = begin;
  bool first = true;
  std::uint64_t deaf = 0;
  Run run;
  const auto hear = [&] {
    const double time = now();
    run.silence = std::max(run.silence, time - std::exchange(last, time));
    // Nobody can ask before there is a simulation.
    if (!std::exchange(first, false)) run.deaf = std::max(run.deaf, deaf);
    deaf = 0;
    return time - begin > seconds;
  };
  const ShouldStop outside = [&deaf] { return ++deaf == 0; };
  const InterruptScope scope(outside);
  run.record = testing::record(scene, a_case.duration, outputs, hear);
  hear();
  return run;
}

bool asks_often(const Case& a_case, const Run& run) {
  if (!a_case.patient) return true;  // sanitizers are slow
  constexpr std::uint64_t many =
      1000000;  // of hundreds of thousands of steps, whose memory the run gives back at its end
  constexpr std::uint64_t few_blocks = 1024;
  return run.deaf <= few_blocks && run.silence <= (run.record.evaluations > many ? 0.3 : 0.1);
}

Verdict judge_interrupted(const Case& a_case, scene::Scene scene, const Record& run) {
  if (!a_case.patient) return {Verdict::Kind::halted, "interrupted", ""};
  if (accumulates(run)) return {Verdict::Kind::halted, "interrupted among switches that accumulate", ""};
  if (gets_on_quickly(run, patience(a_case, scene.solver), a_case.duration))
    return {Verdict::Kind::halted, "interrupted among millions of switches", ""};
  std::ostringstream words;
  words << run.evaluations << " right-hand sides, " << run.switches.size() << " switches";
  const Verdict too_long{Verdict::Kind::found, "a run stays under its limit of processor time", words.str()};
  constexpr std::size_t of_a_start = 20;  // a method begins anew after each switch
  if (scene.solver.uses_closed_forms() || run.evaluations < of_a_start * (run.switches.size() + 1))
    return too_long;
  scene.solver.method = scene::Solver::Method::automatic;
  const Record other = run_for(a_case, scene, 1).record;
  if (other.interrupted && !accumulates(other) &&
      !gets_on_quickly(other, patience(a_case, scene.solver), a_case.duration))
    return too_long;
  return {Verdict::Kind::halted, "interrupted: the method asked for takes far more steps than auto", ""};
}

}  // namespace hybrid_sphere::fuzz
