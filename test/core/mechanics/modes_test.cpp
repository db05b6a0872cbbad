#include "hybrid_sphere/mechanics/modes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "hybrid_sphere/mechanics/equilibrium.hpp"
#include "hybrid_sphere/mechanics/multibody_system.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::modes_test {
namespace {

using Eigen::Vector3d;

constexpr double g = 9.81;
// Differences leave 1e-11 of the sizes of terms, which are some tens here.
constexpr double tolerance = 1e-8;

State present(const Model& model, const Initial& initial) { return solve(model, initial, 0).at(0); }

/// Expects pairs +-i w, the largest w last.
void expect_frequencies(const Modes& modes, std::vector<double> frequencies) {
  ASSERT_EQ(modes.eigenvalues.size(), 2 * Index(frequencies.size())) << modes.eigenvalues;
  std::vector<double> found;
  for (const std::complex<double>& eigenvalue : modes.eigenvalues) {
    EXPECT_NEAR(eigenvalue.real(), 0, tolerance);
    if (eigenvalue.imag() > 0) found.push_back(eigenvalue.imag());
  }
  std::sort(found.begin(), found.end());
  ASSERT_EQ(found.size(), frequencies.size()) << modes.eigenvalues;
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], frequencies[i], tolerance);
}

Model pendulum() {
  return System<1>({"angle"}, [](auto, const auto& q, const auto& v) {
    using std::cos;
    return v[0] * v[0] / 2 + g * cos(q[0]);
  });
}

TEST(Modes, OfAHangingPendulumAreItsFrequency) {
  const Modes found = modes(pendulum(), present(pendulum(), {0, {0.0}, {0.0}}));
  expect_frequencies(found, {std::sqrt(g)});
  EXPECT_EQ(found.neutral, 0);
  EXPECT_GT(found.eigenvalues[0].imag(), 0);
}

TEST(Modes, HaveVelocitiesThatAreTheRatesOfPositions) {
  const Modes found = modes(pendulum(), present(pendulum(), {0, {M_PI}, {0.0}}));
  ASSERT_EQ(found.eigenvalues.size(), 2);
  EXPECT_NEAR(found.eigenvalues[0].real(), std::sqrt(g), tolerance);
  EXPECT_NEAR(found.eigenvalues[1].real(), -std::sqrt(g), tolerance);
  for (Index i = 0; i < 2; ++i) {
    EXPECT_LE(std::abs(found.vectors(1, i) - found.eigenvalues[i] * found.vectors(0, i)), tolerance);
    EXPECT_NEAR(found.vectors.col(i).norm(), 1, 1e-14);
  }
}

// cos(theta) = g / W^2 and w^2 = W^2 (1 + 3 cos^2(theta)); the azimuth and W itself are neutral.
TEST(Modes, OfAConicalPendulumLeaveItsAzimuthOut) {
  const Model conical = System<2>({"theta", "phi"}, [](auto, const auto& q, const auto& v) {
    using std::cos, std::sin;
    const auto across = sin(q[0]) * v[1];
    return (v[0] * v[0] + across * across) / 2 + g * cos(q[0]);
  });
  constexpr double W = 4;
  const State steady = equilibrium(conical, {0, {0.7, 0.2}, {0, W}});
  const double cosine = g / (W * W);
  EXPECT_NEAR(steady.q[0], std::acos(cosine), 1e-12);
  EXPECT_EQ(steady.q[1], 0.2);
  const Modes found = modes(conical, steady);
  expect_frequencies(found, {W * std::sqrt(1 + 3 * cosine * cosine)});
  EXPECT_EQ(found.neutral, 2);
}

/// Two uniform rods of length 1 in a chain.
MultibodySystem chain() {
  const Vector3d axis(0, 1, 0), moments(1.0 / 12, 1.0 / 12, 1e-3);
  MultibodySystem system;
  system.body("upper", 1, {moments[0], moments[1], moments[2]}, Vector3d(0, 0, -0.5))
      .body("lower", 1, {moments[0], moments[1], moments[2]}, Vector3d(0, 0, -1.5))
      .hinge("top", "world", "upper", {0, 0, 0}, axis)
      .hinge("middle", "upper", "lower", {0, 0, -1}, axis);
  return system;
}

// (7/36) x^2 - (7/6) x + 3/4 = 0 with x = w^2 l / g.
TEST(Modes, OfADoublePendulumOfBodiesAreItsTwo) {
  const MultibodySystem system = chain();
  const Modes found = modes(system, present(system, system.initial()));
  const double root = 6 / std::sqrt(7);
  expect_frequencies(found, {std::sqrt(g * (3 - root)), std::sqrt(g * (3 + root))});
  EXPECT_EQ(found.neutral, 0);
}

TEST(Modes, DoNotChangeByConstraintsThatSayTheSame) {
  MultibodySystem system = chain();
  system.hinge("top again", "world", "upper", {0, 0.3, 0}, {0, 1, 0});
  const Modes found = modes(system, present(system, system.initial()));
  const double root = 6 / std::sqrt(7);
  expect_frequencies(found, {std::sqrt(g * (3 - root)), std::sqrt(g * (3 + root))});
}

// The rate s about the second of three axes: +-s sqrt((I2 - I1) (I3 - I2) / (I1 I3)).
TEST(Modes, OfABodyThatSpinsAboutItsMiddleAxisTurnWithIt) {
  MultibodySystem system({0, 0, 0});
  system.body("racket", 1, {2, 3, 4}, Vector3d(0, 0, 0));
  constexpr double spin = 3;
  const Initial start = system.initial({{"racket", {{0, 0, 0}, {0, spin, 0}}}});
  const Solution motion = solve(system, start, 0.4);
  for (const double time : {0.0, 0.4}) {
    const Modes found = modes(system, motion.at(time));
    const double rate = spin * std::sqrt(1 / 8.0);
    ASSERT_GE(found.eigenvalues.size(), 2);
    EXPECT_NEAR(found.eigenvalues[0].real(), rate, 1e-6) << time;
    EXPECT_NEAR(found.eigenvalues[found.eigenvalues.size() - 1].real(), -rate, 1e-6) << time;
  }
}

MultibodySystem coin() {
  constexpr double r = 0.5;
  MultibodySystem system;
  system.body("coin", 1, {r * r / 4, r * r / 2, r * r / 4}, Vector3d(0, 0, r))
      .rolling("table", "coin", ContactShape::disk(r, {0, 1, 0}));
  return system;
}

// A uniform disk that rolls at the rate s: w^2 = (12 s^2 - 4 g / r) / 5.
TEST(Modes, OfACoinThatRollsUpright) {
  const MultibodySystem system = coin();
  for (const double rate : {0.0, 3.0, 6.0}) {
    const Modes found =
        modes(system, present(system, system.initial({{"coin", {{0.5 * rate, 0, 0}, {0, rate, 0}}}})));
    const double square = (12 * rate * rate - 4 * g / 0.5) / 5;
    ASSERT_EQ(found.eigenvalues.size(), 2) << found.eigenvalues;
    const std::complex<double> first = std::sqrt(std::complex<double>(-square));
    EXPECT_LE(std::abs(found.eigenvalues[0] - first), tolerance) << rate;
  }
}

// On the spot about its vertical diameter at the rate s: w^2 = s^2 - 4 g / (5 r), Routh's result.
TEST(Modes, OfACoinThatSpinsOnItsEdge) {
  const MultibodySystem system = coin();
  for (const double rate : {2.0, 7.0}) {
    const Initial start = system.initial({{"coin", {{0, 0, 0}, {0, 0, rate}}}});
    const State state = solve(system, start, 0.3).at(0.3);
    const Modes found = modes(system, state);
    const double square = rate * rate - 4 * g / (5 * 0.5);
    double nearest = 1e9;
    const std::complex<double> expected = std::sqrt(std::complex<double>(-square));
    for (const std::complex<double>& one : found.eigenvalues)
      nearest = std::min(nearest, std::abs(one - expected));
    EXPECT_LE(nearest, 1e-7) << rate << "\n" << found.eigenvalues;
  }
}

TEST(Modes, AreRefusedWhereTheMotionIsNotSteady) {
  try {
    modes(pendulum(), present(pendulum(), {0, {0.3}, {0.0}}));
    FAIL() << "no exception";
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(std::string(error.what()).find("state: its accelerations are off by"), 0) << error.what();
  }
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::modes_test
