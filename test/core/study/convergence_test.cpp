// The mean of a study whose answer is known converges as its samples are said to.

#include <gtest/gtest.h>

#include <cmath>

#include "study/experiment.hpp"

namespace hybrid_sphere::testing::convergence_test {
namespace {

using namespace study;

constexpr double radius = 0.25;
constexpr double duration = 5;

Study study_with(const std::string& sample, std::uint64_t runs, int seed) {
  return read_study_text(
      "scene: {sphere: {mass: 2, radius: 0.25, body: solid}, initial_state: {position: [-3, 0], velocity: "
      "[1, 0]},\n"
      "  surface: {regions: [{name: rough, half_plane: {point: [0, 0], normal: [1, 0]}, law: rough}]}}\n"
      "duration: 5\nkeep: {end: [position]}\nsample: " +
      sample + "\nruns: " + std::to_string(runs) + "\nseed: " + std::to_string(seed) +
      "\nvary:\n  initial_state.velocity[0]: {uniform: [0.9, 1.1]}\n"
      "  initial_state.position[0]: {uniform: [-3.2, -2.8]}\n"
      "  initial_state.angular_velocity[1]: {uniform: [1, 2]}\n");
}

// It slides to x = 0 and rolls on with (5 v + 2 R w)/7, equation (23) corrected: x = (5 v + 2 R w) (T +
// x0/v)/7.
double known_mean() {
  const double inverse_velocity = std::log(1.1 / 0.9) / 0.2;
  return 5.0 / 7 * (duration - 3) + 2 * radius / 7 * 1.5 * (duration - 3 * inverse_velocity);
}

/// Root mean square of the error over seeds.
double error_of(const std::string& sample, std::uint64_t runs) {
  constexpr int seeds = 8;
  double squares = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    const Study study = study_with(sample, runs, seed);
    Experiment experiment(study);
    Chunk chunk(experiment.columns().all);
    experiment.run(0, runs, chunk, [] { return false; });
    double sum = 0;
    for (std::uint64_t i = 0; i < runs; ++i) sum += *chunk.reals(experiment.columns().end, i);
    const double error = sum / static_cast<double>(runs) - known_mean();
    squares += error * error;
  }
  return std::sqrt(squares / seeds);
}

// From 64 to 4096 runs the error falls by 8 for points at random: by 3 to 24 with eight seeds, whose root
// mean squares are off by a factor of 1.7 or less in 99 of 100 cases each.
TEST(MeanOfAStudy, ConvergesWithTheRootOfTheRunsAtRandom) {
  const double ratio = error_of("random", 64) / error_of("random", 4096);
  EXPECT_GT(ratio, 2.7);
  EXPECT_LT(ratio, 24);
}

// Latin hypercubes leave the part of the variance that is no sum of functions of one variable, here a
// hundredth.
TEST(MeanOfAStudy, IsCloserWithALatinHypercube) {
  EXPECT_LT(error_of("latin_hypercube", 4096), error_of("random", 4096) / 5);
}

// Nearly with the runs: 64 times as many make it more than 20 times as exact, for a smooth number.
TEST(MeanOfAStudy, ConvergesFasterWithSobolsSequence) {
  EXPECT_GT(error_of("sobol", 64) / error_of("sobol", 4096), 20);
  EXPECT_LT(error_of("sobol", 4096), error_of("random", 4096) / 50);
}

}  // namespace
}  // namespace hybrid_sphere::testing::convergence_test
