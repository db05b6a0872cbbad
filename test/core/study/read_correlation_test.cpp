// With which words covariances are refused.

#include <gtest/gtest.h>

#include "core/study/study_keys.hpp"

namespace hybrid_sphere::testing::read_correlation_test {
namespace {

/// Of a study with the normal variables mass (deviation 0.5) and velocity[0] (2), and a uniform radius.
void expect_correlation_refused(const std::string& correlate, const std::string& message) {
  expect_refused(Keys()
                     .set("vary",
                          "{sphere.mass: {normal: {mean: 2, deviation: 0.5}}, 'initial_state.velocity[0]': "
                          "{normal: {mean: "
                          "0, deviation: 2}}, sphere.radius: {uniform: [1, 2]}}")
                     .set("correlate", correlate),
                 message);
}

TEST(ReadCorrelation, RefusesCorrelations) {
  const std::string both = "{variables: [sphere.mass, 'initial_state.velocity[0]'], covariance: ";
  const std::string form = "a symmetric, positive definite matrix";
  const std::string of_2 = form + " of 2 rows";
  const std::string at = "correlate[0].covariance";
  expect_correlation_refused("[" + both + "[[0.25, 0.1], [0.1, 4]]}]", "accepted");
  expect_correlation_refused("[]",
                             "correlate: []" + is_refused + "a list of maps with variables and covariance");
  expect_correlation_refused(
      "[{variables: [sphere.mass]}]",
      "correlate[0].variables: [\"sphere.mass\"]" + is_refused + "a list of at least two paths of vary");
  expect_correlation_refused(
      "[{variables: [sphere.mass, sphere.radius]}]",
      "correlate[0].variables[1]: \"sphere.radius\"" + is_refused +
          "the path of a variable with a normal distribution; the nearest one is sphere.mass");
  expect_correlation_refused(
      "[{variables: [sphere.mass, sphere.mass]}]",
      "correlate[0].variables[1]: \"sphere.mass\"" + is_refused + "each variable once");
  expect_correlation_refused("[" + both + "[[0.25, 0.1]]}]", at + ": a list of 1" + is_refused + of_2);
  expect_correlation_refused("[" + both + "[[0.25, 0.1], [0.1]]}]",
                             at + "[1]: [0.1]" + is_refused + "a list of 2 numbers ");
  expect_correlation_refused("[" + both + "[[0.25, 0.1], [0.2, 4]]}]",
                             at + ": a matrix that is not symmetric" + is_refused + of_2);
  expect_correlation_refused("[" + both + "[[0.25, 1], [1, 4]]}]",
                             at + ": a matrix that is not positive definite" + is_refused + form);
  expect_correlation_refused("[" + both + "[[0.25, -3], [-3, 4]]}]",
                             at + ": a matrix that is not positive definite" + is_refused + form);
  expect_correlation_refused(
      "[" + both + "[[0.5, 0.1], [0.1, 4]]}]",
      at + "[0][0]: 0.5" + is_refused + "the square of the variable's deviation, 0.25");
  expect_correlation_refused(
      "[" + both + "[[-0.25, 0.1], [0.1, 4]]}]",
      at + "[0][0]: -0.25" + is_refused + "the square of the variable's deviation, 0.25");
  expect_correlation_refused(
      "[" + both + "[[0.25, 0], [0, 4]]}, " + both + "[[0.25, 0], [0, 4]]}]",
      "correlate[1].variables: \"sphere.mass\" again" + is_refused + "each variable in one covariance");
  expect_refused("correlate", "[{variables: [sphere.mass, sphere.mass]}]",
                 "correlate[0].variables[0]: \"sphere.mass\"" + is_refused +
                     "the path of a variable with a normal distribution; vary has none");
  expect_refused(
      Keys()
          .set("runs", "")
          .set("sample", "grid")
          .set("vary",
               "{sphere.mass: {normal: {mean: 2, deviation: 1}, levels: 2}, 'gravity[0]': {normal: {mean: 0, "
               "deviation: 1}, "
               "levels: 2}}")
          .set("correlate", "[{variables: [sphere.mass, 'gravity[0]'], covariance: [[1, 0], [0, 1]]}]"),
      "correlate: this key together with sample: grid" + is_refused +
          "samples that are drawn: random, latin_hypercube, sobol");
}

TEST(ReadCorrelation, RefusesACovarianceWhoseDeviationHasNoSquare) {
  const auto with = [](const std::string& deviation, const std::string& variance) {
    return Keys()
        .set("vary", "{sphere.mass: {normal: {mean: 2, deviation: " + deviation +
                         "}}, 'gravity[0]': {normal: {mean: 0, deviation: 1}}}")
        .set("correlate",
             "[{variables: [sphere.mass, 'gravity[0]'], covariance: [[" + variance + ", 0], [0, 1]]}]");
  };
  expect_refused(with("1e160", "1e200"), "correlate[0].covariance[0][0]: 1e+200" + is_refused +
                                             "the square of the variable's deviation, inf");
  expect_refused(with("1e-200", "0"), "correlate[0].covariance[0][0]: 0" + is_refused +
                                          "the square of the variable's deviation, 0");
  expect_refused(with("1e100", "1e200"), "accepted");
}

}  // namespace
}  // namespace hybrid_sphere::testing::read_correlation_test
