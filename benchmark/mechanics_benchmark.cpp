// The general engine on every system of the catalogue.
//   equations/NAME   one right-hand side of stage 3 with derivatives by hand and with automatic ones, in
//   turn:
//                    nanoseconds of each, and their ratio
//   run/NAME/1e-A    a whole run at that accuracy: steps, right-hand sides, and the deviation from the known
//                    solution relative to the scale of motion, where there is one
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>

#include "catalogue/catalogue.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"
#include "mechanics/constrained_motion.hpp"

namespace {

using namespace hybrid_sphere::mechanics;

double nanoseconds(ConstrainedMotion& motion, const State& state) {
  constexpr int evaluations = 1000;
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < evaluations; ++i) {
    motion.evaluate_stage(state.time, state.q, state.v);
    benchmark::DoNotOptimize(motion.acceleration().data());
  }
  const std::chrono::duration<double, std::nano> elapsed = std::chrono::steady_clock::now() - start;
  return elapsed.count() / evaluations;
}

void equations(benchmark::State& state, const catalogue::Entry& entry) {
  const catalogue::Example example = entry.build(catalogue::Values(entry.parameters));
  const Solution solution = solve(example.model, example.initial, entry.duration);
  const State where = solution.at(solution.end());
  ConstrainedMotion automatic(example.model);
  ConstrainedMotion by_hand(example.by_hand);
  for (ConstrainedMotion* motion : {&automatic, &by_hand}) {
    motion->set_active(where.active);
    motion->evaluate_stage(where.time, where.q, where.v);
  }
  double sum_automatic = 0;
  double sum_by_hand = 0;
  for (auto _ : state) {
    sum_automatic += nanoseconds(automatic, where);
    sum_by_hand += nanoseconds(by_hand, where);
  }
  const auto rounds = static_cast<double>(state.iterations());
  state.counters["automatic_ns"] = sum_automatic / rounds;
  state.counters["by_hand_ns"] = sum_by_hand / rounds;
  state.counters["ratio"] = sum_automatic / sum_by_hand;
}

/// Largest deviation of q from the known solution at 100 instants, relative to its largest component.
double deviation(const catalogue::Example& example, const Solution& solution) {
  constexpr int instants = 100;
  double largest = 0;
  double size = 0;
  for (int i = 0; i <= instants; ++i) {
    const double t = solution.begin() + (solution.end() - solution.begin()) * i / instants;
    const auto known = example.known ? example.known(t) : std::nullopt;
    if (!known) continue;
    size = std::max(size, known->q.lpNorm<Eigen::Infinity>());
    largest = std::max(largest, (solution.at(t).q - known->q).lpNorm<Eigen::Infinity>());
  }
  return size > 0 ? largest / size : 0;
}

void run(benchmark::State& state, const catalogue::Entry& entry, double accuracy) {
  const catalogue::Example example = entry.build(catalogue::Values(entry.parameters));
  Options options;
  options.accuracy = accuracy;
  for (auto _ : state) {
    benchmark::DoNotOptimize(solve(example.model, example.initial, entry.duration, options).end());
  }
  const Solution solution = solve(example.model, example.initial, entry.duration, options);
  state.counters["steps"] = static_cast<double>(solution.steps());
  state.counters["evaluations"] = static_cast<double>(solution.evaluations());
  state.counters["deviation"] = deviation(example, solution);
}

}  // namespace

int main(int argc, char** argv) {
  for (const catalogue::Entry& entry : catalogue::entries()) {
    benchmark::RegisterBenchmark(("equations/" + entry.name).c_str(),
                                 [&entry](benchmark::State& state) { equations(state, entry); });
    for (const auto& [name, accuracy] :
         {std::pair("1e-3", 1e-3), {"1e-6", 1e-6}, {"1e-9", 1e-9}, {"1e-12", 1e-12}}) {
      benchmark::RegisterBenchmark(
          ("run/" + entry.name + "/" + name).c_str(),
          [&entry, accuracy = accuracy](benchmark::State& state) { run(state, entry, accuracy); });
    }
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
}
