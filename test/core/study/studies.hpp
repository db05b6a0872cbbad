#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "study/experiment.hpp"

/// Studies whose runs pass over several grounds, and what their runs leave.
namespace hybrid_sphere::testing {

using namespace study;

inline const std::function<bool()> go_on = [] { return false; };

/// The numbers of one run: a column after another, codes as numbers.
inline std::vector<double> numbers_of_run(const std::vector<Column>& columns, Chunk& chunk,
                                          std::uint64_t run) {
  std::vector<double> numbers;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    for (std::size_t k = 0; k < columns[i].size(); ++k) {
      const bool is_real = columns[i].type == Column::Type::real;
      numbers.push_back(is_real ? chunk.reals(i, run)[k] : chunk.codes(i, run)[k]);
    }
  }
  return numbers;
}

inline std::uint64_t bits_of(double number) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &number, sizeof bits);
  return bits;
}

/// To the bit; NaN is NaN.
inline bool are_same(const std::vector<double>& a, const std::vector<double>& b) {
  const auto same = [](double x, double y) {
    return (std::isnan(x) && std::isnan(y)) || bits_of(x) == bits_of(y);
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
}

inline std::vector<std::vector<double>> runs_of(Experiment& experiment, std::uint64_t first,
                                                std::uint64_t count) {
  Chunk chunk(experiment.columns().all);
  experiment.run(first, count, chunk, go_on);
  std::vector<std::vector<double>> runs;
  for (std::uint64_t i = 0; i < count; ++i)
    runs.push_back(numbers_of_run(experiment.columns().all, chunk, i));
  return runs;
}

inline const std::string keep_all =
    "keep:\n"
    "  end: [position, velocity, angular_velocity, orientation, slip, energy, stage, mode, region]\n"
    "  at: {times: [0, 0.3, 1.25], fields: [region, position, stage, slip, orientation]}\n"
    "  switches: {first: 3}\n"
    "  extremes: {of: [slip, speed, energy_lost, spin], instants: 7}\n";

// Friction, a belt, ice, and two regions with the law of what is around them.
inline const std::string floor =
    "scene:\n"
    "  sphere: {mass: 2, radius: 0.25, body: solid}\n"
    "  initial_state: {position: [-1, 0.1], velocity: [1.5, 0.1], angular_velocity: [1, 2, 3]}\n"
    "  surface:\n"
    "    base: {law: coulomb, friction: 0.3}\n"
    "    regions:\n"
    "      - {name: same, law: coulomb, friction: 0.3, circle: {center: [-0.5, 0], radius: 0.4}}\n"
    "      - {name: belt, law: rough, belt: [0.5, 0.1], polygon: [[0, -3], [1, -3], [1, 3], [0, 3]]}\n"
    "      - {name: ice, law: smooth, half_plane: {point: [1, 0], normal: [1, 0]}}\n"
    "      - {name: ice again, law: smooth, circle: {center: [2, 0], radius: 0.5}}\n";

inline std::string study_of(const std::string& scene, const std::string& vary, int runs, int seed,
                            const std::string& entered = "[same, belt, ice, ice again, base]") {
  return scene + "runs: " + std::to_string(runs) + "\nseed: " + std::to_string(seed) +
         "\nduration: 2\nvary:\n" + vary + keep_all + "  entered: " + entered + "\n";
}

inline const std::string start =
    "  initial_state.velocity[0]: {normal: {mean: 1.5, deviation: 0.5}}\n"
    "  initial_state.velocity[1]: {uniform: [-1, 1]}\n"
    "  initial_state.position[1]: {normal: {mean: 0, deviation: 0.5}}\n"
    "  initial_state.angular_velocity[2]: {uniform: [-5, 5]}\n";

}  // namespace hybrid_sphere::testing
