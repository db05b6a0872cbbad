// What distributions are read as, and with which words everything else is refused.

#include "study/read_distribution.hpp"

#include <gtest/gtest.h>

#include "scene/yaml.hpp"

namespace hybrid_sphere::testing::read_distribution_test {
namespace {

using namespace study;

Distribution read(const std::string& yaml) {
  return read_distribution(scene::tree_from_yaml(yaml), "vary.sphere.mass");
}

template <class Kind>
Kind read_as(const std::string& yaml) {
  return std::get<Kind>(read(yaml));
}

std::string refusal(const std::string& yaml) {
  try {
    read(yaml);
  } catch (const scene::SceneError& error) {
    return error.what();
  }
  return "accepted";
}

/// Without the path that all have in common.
void expect_refused(const std::string& yaml, const std::string& message) {
  EXPECT_EQ(refusal(yaml), "vary.sphere.mass" + message) << yaml;
}

TEST(ReadDistribution, TakesEachKind) {
  const auto uniform = read_as<Uniform>("uniform: [-1, 2.5]");
  EXPECT_EQ(uniform.low, -1);
  EXPECT_EQ(uniform.high, 2.5);
  const auto log_uniform = read_as<LogUniform>("log_uniform: [1e-9, 1e9]");
  EXPECT_EQ(log_uniform.low, 1e-9);
  EXPECT_EQ(log_uniform.high, 1e9);
  const auto normal = read_as<Normal>("normal: {mean: 0, deviation: 0.05}");
  EXPECT_EQ(normal.mean, 0);
  EXPECT_EQ(normal.deviation, 0.05);
  const auto lognormal = read_as<Lognormal>("lognormal: {median: 3, log_deviation: 0.5}");
  EXPECT_EQ(lognormal.median, 3);
  EXPECT_EQ(lognormal.log_deviation, 0.5);
  const auto triangular = read_as<Triangular>("triangular: [1, 2, 4]");
  EXPECT_EQ(triangular.low, 1);
  EXPECT_EQ(triangular.mode, 2);
  EXPECT_EQ(triangular.high, 4);
}

TEST(ReadDistribution, TakesATruncatedNormalOneWithoutProbability) {
  const auto read =
      read_as<TruncatedNormal>("truncated_normal: {mean: 1, deviation: 2, low: 1000, high: 1001}");
  EXPECT_EQ(read.mean, 1);
  EXPECT_EQ(read.deviation, 2);
  EXPECT_EQ(read.low, 1000);
  EXPECT_EQ(read.high, 1001);
}

TEST(ReadDistribution, TakesAModeAtAnEnd) {
  EXPECT_EQ(read_as<Triangular>("triangular: [1, 1, 4]").mode, 1);
  EXPECT_EQ(read_as<Triangular>("triangular: [1, 4, 4]").mode, 4);
}

TEST(ReadDistribution, PutsValuesInOrderWithEqualShares) {
  const auto read = read_as<Values>("values: [3, -1, 2, 2]");
  EXPECT_EQ(read.values, (std::vector<double>{-1, 2, 2, 3}));
  EXPECT_EQ(read.until, (std::vector<double>{0.25, 0.5, 0.75, 1}));
}

TEST(ReadDistribution, KeepsTheWeightsWithTheirValues) {
  const auto read = read_as<Values>("values: {values: [3, 1, 2], weights: [0, 4, 12]}");
  EXPECT_EQ(read.values, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(read.until, (std::vector<double>{0.25, 1, 1}));
}

TEST(ReadDistribution, TakesWeightsOfAnySize) {
  const auto read = read_as<Values>("values: {values: [1, 2, 3], weights: [1e+300, 1e+300, 1e+300]}");
  EXPECT_DOUBLE_EQ(read.until[0], 1.0 / 3);
  EXPECT_EQ(read.until[2], 1);
}

TEST(ReadDistribution, RefusesAnythingButOneKind) {
  const std::string kinds = "uniform, log_uniform, normal, truncated_normal, lognormal, triangular, values";
  expect_refused("{}", ": no distribution is refused; allowed: exactly one of " + kinds);
  expect_refused("{uniform: [0, 1], values: [1]}",
                 ": 2 distributions is refused; allowed: exactly one of " + kinds);
  expect_refused("3", ": 3 is refused; allowed: a map of keys");
  expect_refused("unifrom: [0, 1]",
                 ".unifrom: an unknown key is refused (did you mean uniform?); allowed: " + kinds);
  expect_refused("{uniform: [0, 1], uniform: [0, 1]}",
                 ".uniform: a second value is refused; allowed: each key once");
}

TEST(ReadDistribution, RefusesIntervalsThatAreNone) {
  const std::string form = " is refused; allowed: [low, high]";
  expect_refused("uniform: [2, 1]", ".uniform: [2, 1]" + form + " with low < high");
  expect_refused("uniform: [1, 1]", ".uniform: [1, 1]" + form + " with low < high");
  expect_refused("uniform: [1]", ".uniform: [1]" + form);
  expect_refused("uniform: [1, 2, 3]", ".uniform: [1, 2, 3]" + form);
  expect_refused("uniform: 5", ".uniform: 5" + form);
  expect_refused("uniform: {low: 1, high: 2}", ".uniform: a map with 2 keys" + form);
  expect_refused("log_uniform: [2, 1]", ".log_uniform: [2, 1]" + form + " with low < high");
}

TEST(ReadDistribution, RefusesWhatIsNoFiniteNumber) {
  const std::string allowed = " is refused; allowed: a number from -1e+300 to 1e+300";
  expect_refused("uniform: [a, 1]", ".uniform[0]: \"a\"" + allowed);
  expect_refused("uniform: [0, .inf]", ".uniform[1]: inf" + allowed);
  expect_refused("uniform: [0, 1e+301]", ".uniform[1]: 1e+301" + allowed);
  expect_refused("uniform: [-1e+301, 0]", ".uniform[0]: -1e+301" + allowed);
  expect_refused("normal: {mean: .nan, deviation: 1}", ".normal.mean: nan" + allowed);
  expect_refused("triangular: [0, [1], 2]", ".triangular[1]: [1]" + allowed);
  expect_refused("values: [0, true]", ".values[1]: true" + allowed);
  expect_refused("uniform: [0, 1e-301]",
                 ".uniform[1]: 1e-301 is refused; allowed: 0, or a number of at least 1e-300 in magnitude");
}

TEST(ReadDistribution, RefusesNumbersThatAreNotPositive) {
  const std::string allowed = " is refused; allowed: a number from 1e-300 to 1e+300";
  expect_refused("log_uniform: [0, 1]", ".log_uniform[0]: 0" + allowed);
  expect_refused("log_uniform: [-2, -1]", ".log_uniform[0]: -2" + allowed);
  expect_refused("normal: {mean: 0, deviation: 0}", ".normal.deviation: 0" + allowed);
  expect_refused("normal: {mean: 0, deviation: -1}", ".normal.deviation: -1" + allowed);
  expect_refused("truncated_normal: {mean: 0, deviation: -1, low: 0, high: 1}",
                 ".truncated_normal.deviation: -1" + allowed);
  expect_refused("lognormal: {median: 0, log_deviation: 1}", ".lognormal.median: 0" + allowed);
  expect_refused("lognormal: {median: 1, log_deviation: 0}",
                 ".lognormal.log_deviation: 0 is refused; allowed: a number from 1e-300 to 100");
  expect_refused("lognormal: {median: 1, log_deviation: 101}",
                 ".lognormal.log_deviation: 101 is refused; allowed: a number from 1e-300 to 100");
}

TEST(ReadDistribution, RefusesMapsWithOtherKeys) {
  expect_refused("normal: {mean: 0}",
                 ".normal.deviation: is missing; allowed: a number from 1e-300 to 1e+300");
  expect_refused("lognormal: {log_deviation: 1}",
                 ".lognormal.median: is missing; allowed: a number from 1e-300 to 1e+300");
  expect_refused("truncated_normal: {mean: 0, deviation: 1, low: 0}",
                 ".truncated_normal.high: is missing; allowed: a number from -1e+300 to 1e+300");
  expect_refused("normal: {mean: 0, deviation: 1, low: 0}",
                 ".normal.low: an unknown key is refused; allowed: mean, deviation");
  expect_refused("normal: [0, 1]", ".normal: [0, 1] is refused; allowed: a map of keys");
  expect_refused("values: {values: [1]}",
                 ".values.weights: is missing; allowed: a list of numbers, a weight of each value");
  expect_refused("values: {weights: [1]}",
                 ".values.values: is missing; allowed: a list of 1 to 100000 numbers");
}

TEST(ReadDistribution, RefusesTruncationToNothing) {
  expect_refused("truncated_normal: {mean: 0, deviation: 1, low: 2, high: 1}",
                 ".truncated_normal.high: 1 is refused; allowed: a number above that of low, 2");
  expect_refused("truncated_normal: {mean: 0, deviation: 1, low: 2, high: 2}",
                 ".truncated_normal.high: 2 is refused; allowed: a number above that of low, 2");
}

TEST(ReadDistribution, RefusesAModeOutside) {
  expect_refused("triangular: [1, 5, 4]", ".triangular[1]: 5 is refused; allowed: a number from 1 to 4");
  expect_refused("triangular: [1, 0, 4]", ".triangular[1]: 0 is refused; allowed: a number from 1 to 4");
  expect_refused("triangular: [1, 1, 1]",
                 ".triangular: [1, 1, 1] is refused; allowed: [low, mode, high] with low < high");
  expect_refused("triangular: [1, 2]", ".triangular: [1, 2] is refused; allowed: [low, mode, high]");
}

TEST(ReadDistribution, RefusesNoneOrTooManyValues) {
  const std::string allowed = " is refused; allowed: a list of 1 to 100000 numbers";
  expect_refused("values: []", ".values: a list of 0" + allowed);
  expect_refused("values: {values: [], weights: []}", ".values.values: a list of 0" + allowed);
  expect_refused("values: 3", ".values: 3" + allowed);
  using scene::Tree;
  const Tree most = Tree::List(100000, Tree(1.0));
  const Tree more = Tree::List(100001, Tree(1.0));
  EXPECT_NO_THROW(read_distribution(Tree::Map{{"values", most}}, "a"));
  try {
    read_distribution(Tree::Map{{"values", more}}, "a");
    ADD_FAILURE() << "accepted";
  } catch (const scene::SceneError& error) {
    EXPECT_EQ(error.what(), "a.values: a list of 100001" + allowed);
  }
}

TEST(ReadDistribution, RefusesWeightsThatAreNone) {
  const auto with = [](const std::string& weights) {
    return "values: {values: [1, 2], weights: " + weights + "}";
  };
  const std::string form = " is refused; allowed: a list of 2 numbers, a weight of each value";
  expect_refused(with("[1]"), ".values.weights: [1]" + form);
  expect_refused(with("[1, 2, 3]"), ".values.weights: [1, 2, 3]" + form);
  expect_refused(with("7"), ".values.weights: 7" + form);
  expect_refused(with("[1, -1]"), ".values.weights[1]: -1 is refused; allowed: a number from 0 to 1e+300");
  expect_refused(with("[0, 0]"), ".values.weights: [0, 0] is refused; allowed: weights that are not all 0");
}

}  // namespace
}  // namespace hybrid_sphere::testing::read_distribution_test
