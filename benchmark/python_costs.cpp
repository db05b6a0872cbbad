// What the Python module is compared with by python_costs.py: the same computations in C++, in one thread;
// CSV, one line for each figure:
//   what,ns
// outputs: a thousand states of a scene, each advance_to() and state(); the median of many such runs. runs:
// short runs of the paper's scene, each set_initial_state(), advance_to() and state().
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <vector>

#include "hybrid_sphere/scene/read_scene.hpp"
#include "hybrid_sphere/simulation/simulation.hpp"

namespace {

using namespace hybrid_sphere;
using Clock = std::chrono::steady_clock;

constexpr double duration = 5;  // [s]

double since(Clock::time_point start) {
  return std::chrono::duration<double, std::nano>(Clock::now() - start).count();
}

void measure_outputs(const std::string& name, int repetitions) {
  constexpr int outputs = 1000;
  Simulation simulation(scene::read_scene_file(SCENES "/" + name + ".yaml"));
  std::vector<double> took;
  for (int i = 0; i < repetitions; ++i) {
    simulation.reset();
    const auto start = Clock::now();
    std::vector<State> states;
    states.reserve(outputs);
    for (int k = 1; k <= outputs; ++k) {
      simulation.advance_to(k * duration / outputs);
      states.push_back(simulation.state());
    }
    took.push_back(since(start));
  }
  const auto middle = took.begin() + repetitions / 2;
  std::nth_element(took.begin(), middle, took.end());
  std::printf("outputs %s,%.4g\n", name.c_str(), *middle / outputs);
}

void measure_runs(int runs, bool orientation) {
  scene::Scene scene = scene::read_scene_file(SCENES "/paper.yaml");
  Simulation simulation(scene);
  simulation.follow_orientation(orientation);
  const auto start = Clock::now();
  std::vector<State> states;
  states.reserve(static_cast<std::size_t>(runs));
  for (int i = 0; i < runs; ++i) {
    scene.initial_state.velocity.x() = 1 + static_cast<double>(i) / runs;
    simulation.set_initial_state(scene.initial_state);
    simulation.advance_to(duration);
    states.push_back(simulation.state());
  }
  std::printf("runs %s,%.4g\n", orientation ? "whole" : "places", since(start) / runs);
}

}  // namespace

int main() {
  std::puts("what,ns");
  measure_outputs("paper", 2000);
  measure_outputs("incline", 200);
  measure_outputs("turntable", 50);
  measure_runs(1000000, true);
  measure_runs(1000000, false);
}
