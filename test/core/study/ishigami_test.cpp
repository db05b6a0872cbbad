// Sobol' indices of a function whose indices are known, by all that a study does but the simulation.

#include <gtest/gtest.h>

#include <cmath>

#include "study/analysis.hpp"
#include "study/experiment.hpp"
#include "support/temporary_file.hpp"

namespace hybrid_sphere::testing::ishigami_test {
namespace {

using namespace study;

constexpr double a = 7;
constexpr double b = 0.1;
const double pi = std::acos(-1.0);

/// T. Ishigami, T. Homma, Proc. ISUMA '90, 398-403.
double ishigami(const double* x) {
  return std::sin(x[0]) + a * std::pow(std::sin(x[1]), 2) + b * std::pow(x[2], 4) * std::sin(x[0]);
}

Study study_with(const std::string& sample, std::uint64_t groups) {
  const std::string range = "{uniform: [-3.141592653589793, 3.141592653589793]}";
  return read_study_text(
      "scene: {sphere: {mass: 1, radius: 1, body: solid}}\n"
      "runs: " +
      std::to_string(5 * groups) + "\nsample: " + sample +
      "\nseed: 3\nduration: 1\nsensitivity: sobol\nkeep: {end: [energy]}\n"
      "vary:\n  initial_state.position[0]: " +
      range + "\n  initial_state.velocity[0]: " + range + "\n  initial_state.angular_velocity[2]: " + range +
      "\n");
}

/// The function in place of the energy at the end.
Analysis analysis_of(const Study& study) {
  const Experiment experiment(study);
  const Columns& columns = experiment.columns();
  const Samples samples(study);
  const TemporaryFile file("ishigami.journal");
  Journal journal = Journal::create(file.path(), "ishigami");
  std::vector<double> values;
  std::vector<unsigned char> bytes;
  Chunk chunk(columns.all);
  for (std::uint64_t number = 0; number * study.chunk < study.runs; ++number) {
    const std::uint64_t count = std::min(study.chunk, study.runs - number * study.chunk);
    values.resize(3 * count);
    samples.values(number * study.chunk, count, values.data());
    chunk.begin(number * study.chunk, count);
    for (std::uint64_t i = 0; i < count; ++i) {
      *chunk.reals(columns.end, i) = ishigami(&values[3 * i]);
      *chunk.codes(columns.outcome, i) = 0;
    }
    chunk.encode(bytes);
    journal.append(number, bytes);
  }
  return analyse(Results(study, columns, journal));
}

const SobolIndices& indices_of(const Analysis& analysis) {
  for (const NumberAnalysis& number : analysis.numbers) {
    if (number.name == "end/energy") return number.sensitivity;
  }
  throw std::logic_error("no sensitivity of end/energy");
}

TEST(Ishigami, HasTheIndicesThatAreKnown) {
  const double first = std::pow(1 + b * std::pow(pi, 4) / 5, 2) / 2;
  const double second = a * a / 8;
  const double together = 8 * b * b * std::pow(pi, 8) / 225;
  const double variance = first + second + together;
  for (const char* sample : {"sobol"}) {
    const Analysis analysis = analysis_of(study_with(sample, 1 << 14));
    const SobolIndices& found = indices_of(analysis);
    const double expected_first[] = {first / variance, second / variance, 0};
    const double expected_total[] = {(first + together) / variance, second / variance, together / variance};
    EXPECT_NEAR(found.variance, variance, 0.01 * variance);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(found.first[i].value, expected_first[i], 0.01) << i;
      EXPECT_NEAR(found.total[i].value, expected_total[i], 0.01) << i;
    }
  }
}

// Points at random are off by what their interval says.
TEST(Ishigami, IsWithinTheIntervalsOfPointsAtRandom) {
  const double first = std::pow(1 + b * std::pow(pi, 4) / 5, 2) / 2;
  const double second = a * a / 8;
  const double together = 8 * b * b * std::pow(pi, 8) / 225;
  const double variance = first + second + together;
  int inside = 0;
  for (const char* sample : {"random", "latin_hypercube"}) {
    const Analysis analysis = analysis_of(study_with(sample, 1 << 12));
    const SobolIndices& found = indices_of(analysis);
    const double expected_first[] = {first / variance, second / variance, 0};
    const double expected_total[] = {(first + together) / variance, second / variance, together / variance};
    for (std::size_t i = 0; i < 3; ++i) {
      inside += found.first[i].low <= expected_first[i] && expected_first[i] <= found.first[i].high ? 1 : 0;
      inside += found.total[i].low <= expected_total[i] && expected_total[i] <= found.total[i].high ? 1 : 0;
    }
  }
  EXPECT_GE(inside, 10);  // of 12: three or more outside have a probability of 2 %
}

}  // namespace
}  // namespace hybrid_sphere::testing::ishigami_test
