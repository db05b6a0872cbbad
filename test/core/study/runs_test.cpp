// Runs of a study do not depend on each other, nor on who computes them; what they leave where nothing is to
// be left; their samples and the names of their columns.

#include <gtest/gtest.h>

#include <cmath>

#include "core/study/studies.hpp"
#include "study/experiment.hpp"

namespace hybrid_sphere::testing::runs_test {
namespace {

TEST(Run, IsTheSameInAnyCutIntoBlocks) {
  const std::string vary[] = {start, start + "  surface.base.friction: {uniform: [-0.1, 0.5]}\n"};
  for (const std::string& each : vary) {
    const Study study = read_study_text(study_of(floor, each, 50, 6) + "sample: latin_hypercube\n");
    Experiment whole(study);
    const std::vector<std::vector<double>> expected = runs_of(whole, 0, 50);
    Experiment cut(study);
    const std::pair<std::uint64_t, std::uint64_t> blocks[] = {{49, 1}, {0, 7}, {7, 30}, {37, 12}, {0, 7}};
    for (const auto& [first, count] : blocks) {
      const std::vector<std::vector<double>> found = runs_of(cut, first, count);
      for (std::uint64_t i = 0; i < count; ++i)
        EXPECT_TRUE(are_same(found[i], expected[first + i])) << first + i;
    }
  }
}

TEST(Run, IsTheSameAfterOneThatWasInterrupted) {
  const Study study = read_study_text(study_of(floor + "  drag: {quadratic: 0.1}\n", start, 10, 6));
  Experiment experiment(study);
  const std::vector<std::vector<double>> expected = runs_of(experiment, 0, 10);
  Chunk chunk(experiment.columns().all);
  for (const int most : {0, 1, 2, 3}) {
    int questions = 0;
    EXPECT_THROW(experiment.run(0, 10, chunk, [&] { return questions++ >= most; }), Interrupted);
    const std::vector<std::vector<double>> found = runs_of(experiment, 0, 10);
    for (std::uint64_t i = 0; i < 10; ++i) EXPECT_TRUE(are_same(found[i], expected[i])) << i;
  }
}

TEST(Run, AsksTheFunctionOfItsOwnCall) {
  const Study study = read_study_text(study_of(floor + "  drag: {quadratic: 0.1}\n", start, 10, 6));
  Experiment experiment(study);
  Chunk chunk(experiment.columns().all);
  int first = 0;
  int second = 0;
  experiment.run(0, 5, chunk, [&] { return ++first < 0; });
  const int asked = first;
  experiment.run(5, 5, chunk, [&] { return ++second < 0; });
  EXPECT_EQ(first, asked);
  EXPECT_GT(second, 1) << "within runs, too";
}

TEST(Run, LeavesNothingButItsSampleWhereTheSceneRefusesIt) {
  const Study study =
      read_study_text(study_of(floor, "  surface.base.friction: {values: [-0.5, 0.25]}\n", 20, 7));
  Experiment experiment(study);
  Chunk chunk(experiment.columns().all);
  experiment.run(0, 20, chunk, go_on);
  std::size_t refused = 0;
  for (std::uint64_t run = 0; run < 20; ++run) {
    const std::vector<double> numbers = numbers_of_run(experiment.columns().all, chunk, run);
    if (numbers[0] > 0) {
      EXPECT_EQ(numbers[1], static_cast<double>(Outcome::done)) << "also after one that was refused";
      continue;
    }
    ASSERT_LT(refused, chunk.refusals.size());
    EXPECT_EQ(chunk.refusals[refused].run, run);
    EXPECT_EQ(chunk.refusals[refused].path, "surface.base.friction");
    EXPECT_EQ(chunk.refusals[refused].value, "-0.5");
    ++refused;
    EXPECT_EQ(numbers[1], static_cast<double>(Outcome::refused));
    for (std::size_t i = 2; i < numbers.size(); ++i)
      EXPECT_TRUE(std::isnan(numbers[i]) || numbers[i] == -1) << i;
  }
  EXPECT_EQ(refused, chunk.refusals.size());
  EXPECT_GT(refused, 3U);
  EXPECT_LT(refused, 17U);
}

TEST(Run, IsRefusedAlsoWhereTheInitialStateAloneVaries) {
  const Study study = read_study_text(
      study_of(floor, "  initial_state.velocity[0]: {values: [1, 2e15, 1.0e-70, 2]}\n", 40, 7));
  Experiment experiment(study);
  ASSERT_TRUE(experiment.variation().varies_initial_state_alone());
  Chunk chunk(experiment.columns().all);
  experiment.run(0, 40, chunk, go_on);
  EXPECT_GT(chunk.refusals.size(), 10U);
  for (const Refusal& refusal : chunk.refusals) {
    EXPECT_EQ(refusal.path, "initial_state.velocity[0]");
    EXPECT_TRUE(refusal.value == "2e+15" || refusal.value == "1e-70") << refusal.value;
  }
}

TEST(Run, EntersAGroundOfEqualLawWhenTheSphereComesThere) {
  // At 1 m/s from -1 over smooth ground to a smooth disc whose edge is at -0.5.
  const Study study = read_study_text(
      "scene: {sphere: {mass: 1, radius: 1, body: solid}, surface: {regions: [{name: disc, law: smooth, "
      "circle: {center: "
      "[0, 0], radius: 0.5}}, {name: far, law: smooth, circle: {center: [9, 0], radius: 0.5}}]}, "
      "initial_state: {position: "
      "[-1, 0], velocity: [1, 0]}}\nruns: 1\nduration: 4\nvary: {'initial_state.angular_velocity[2]': "
      "{uniform: [0, 1]}}\n"
      "keep: {entered: [far, disc, base]}\n");
  Experiment experiment(study);
  Chunk chunk(experiment.columns().all);
  experiment.run(0, 1, chunk, go_on);
  const double* const entered = chunk.reals(experiment.columns().entered, 0);
  EXPECT_TRUE(std::isnan(entered[0]));
  EXPECT_EQ(entered[1], 0.5);
  EXPECT_EQ(entered[2], 0);
}

TEST(Samples, HaveTheCovarianceThatIsAskedFor) {
  const Study study = read_study_text(
      "scene: {sphere: {mass: 1, radius: 1, body: solid}}\nruns: 1e5\nseed: 3\nduration: 1\nkeep: {}\n"
      "vary: {'gravity[0]': {normal: {mean: 1, deviation: 2}}, sphere.mass: {uniform: [1, 2]}, 'gravity[1]': "
      "{normal: "
      "{mean: -3, deviation: 1}}, 'initial_state.position[0]': {normal: {mean: 0, deviation: 3}}}\n"
      "correlate: [{variables: ['initial_state.position[0]', 'gravity[0]', 'gravity[1]'], covariance: [[9, "
      "-3, 0.6], [-3, 4, "
      "1], [0.6, 1, 1]]}]\n");
  constexpr std::size_t runs = 100000;
  std::vector<double> values(runs * 4);
  Samples(study).values(0, runs, values.data());
  const double mean[] = {1, 1.5, -3, 0};
  const double covariance[4][4] = {{4, 0, 1, -3}, {0, 1. / 12, 0, 0}, {1, 0, 1, 0.6}, {-3, 0, 0.6, 9}};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = 0;
      for (std::size_t run = 0; run < runs; ++run)
        sum += (values[4 * run + i] - mean[i]) * (values[4 * run + j] - mean[j]);
      // The variance of a product of two normal numbers is S_ii S_jj + S_ij^2; five deviations of a mean of
      // 1e5.
      const double s = covariance[i][j];
      const double bound = 5 * std::sqrt((covariance[i][i] * covariance[j][j] + s * s) / runs);
      EXPECT_NEAR(sum / runs, s, bound) << i << ", " << j;
    }
  }
}

TEST(Samples, OfOneRunAreThoseOfTheWholeStudy) {
  const Study study =
      read_study_text(study_of(floor, start, 50, 1) +
                      "correlate: [{variables: ['initial_state.position[1]', 'initial_state.velocity[0]'], "
                      "covariance: [[0.25, -0.2], [-0.2, 0.25]]}]\n");
  const Samples samples(study);
  std::vector<double> whole(std::size_t{50} * 4);
  samples.values(0, 50, whole.data());
  for (std::uint64_t run = 0; run < 50; ++run) {
    std::vector<double> one(4);
    samples.values(run, 1, one.data());
    EXPECT_TRUE(std::equal(one.begin(), one.end(), whole.begin() + static_cast<std::ptrdiff_t>(4 * run)))
        << run;
  }
}

TEST(Experiment, SaysBeforeTheRunsThatTheMethodExactIsImpossible) {
  const std::string yaml =
      study_of(floor + "  drag: {quadratic: 0.1}\n  solver: {method: exact}\n", start, 10, 6);
  const Study study = read_study_text(yaml);
  EXPECT_THROW(Experiment{study}, scene::SceneError);
}

TEST(Columns, HaveNamesOfTheirOwn) {
  const Study study = read_study_text(
      "scene: {sphere: {mass: 1, radius: 1, body: solid}, surface: {regions: [{name: a/b, law: rough, "
      "circle: {center: [0, "
      "0], radius: 1}}, {name: a%2Fb, law: rough, circle: {center: [0, 0], radius: 1}}]}}\nruns: "
      "1\nduration: 1\nkeep: {}\n"
      "vary: {'surface.regions[a/b].circle.radius': {uniform: [1, 2]}, "
      "'surface.regions[a%2Fb].circle.radius': {uniform: "
      "[1, 2]}}\n");
  const Columns columns = columns_of(study, scene_of(study, study.scene_tree));
  EXPECT_EQ(columns.all[0].name, "samples/surface.regions[a%2Fb].circle.radius");
  EXPECT_EQ(columns.all[1].name, "samples/surface.regions[a%252Fb].circle.radius");
}

}  // namespace
}  // namespace hybrid_sphere::testing::runs_test
