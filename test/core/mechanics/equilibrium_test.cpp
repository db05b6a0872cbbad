#include "hybrid_sphere/mechanics/equilibrium.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "hybrid_sphere/mechanics/multibody_system.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::equilibrium_test {
namespace {

constexpr double g = 9.81;

// Newton's method converges until accelerations are some 1e-16 of their terms.
constexpr double tolerance = 1e-13;

TEST(Equilibrium, OfAPendulumWithATorqueIsItsFormula) {
  for (const double torque : {-9.0, 0.0, 3.0}) {
    const Model pendulum = System<1>(
        {"angle"},
        [](auto, const auto& q, const auto& v) {
          using std::cos;
          return v[0] * v[0] / 2 + g * cos(q[0]);
        },
        [torque](auto, const auto&, const auto&) { return torque; });
    EXPECT_NEAR(equilibrium(pendulum, {0, {0.4}, {0.0}}).q[0], std::asin(torque / g), tolerance) << torque;
  }
}

Model swinging_on_rod() {
  return System<2>({"x", "z"}, [](auto, const auto& q,
                                  const auto& v) { return (v[0] * v[0] + v[1] * v[1]) / 2 - g * q[1]; })
      .holonomic(
          "rod", [](auto, const auto& q) { return (q[0] * q[0] + q[1] * q[1] - 4) / 4; }, always());
}

TEST(Equilibrium, IsOnTheConstraintsOnPositions) {
  const State found = equilibrium(swinging_on_rod(), {0, {1.1, -1.4}, {0, 0}});
  EXPECT_NEAR(found.q[0], 0, tolerance);
  EXPECT_NEAR(found.q[1], -2, tolerance);
  EXPECT_NEAR(found.multipliers[0], -g, 1e-12);  // z'' = -g + lambda z / 2 = 0
  EXPECT_EQ(found.v.norm(), 0);
}

// A chain of two bodies hangs down, also where a hinge is there twice.
TEST(Equilibrium, OfAChainOfBodiesHangsDown) {
  for (const bool is_redundant : {false, true}) {
    MultibodySystem chain;
    chain.body("upper", 1, {0.1, 0.1, 0.01}, Eigen::Vector3d(0.3, 0, -0.4))
        .body("lower", 2, {0.1, 0.1, 0.01}, Eigen::Vector3d(0.9, 0, -1.2))
        .hinge("top", "world", "upper", {0, 0, 0}, {0, 1, 0})
        .hinge("middle", "upper", "lower", {0.6, 0, -0.8}, {0, 1, 0});
    if (is_redundant) chain.hinge("top again", "world", "upper", {0, 0.2, 0}, {0, 1, 0});
    Initial guess = chain.initial();
    const State found = equilibrium(chain, guess);
    const Eigen::Vector3d upper = chain.pose(found.q, "upper").translation();
    const Eigen::Vector3d lower = chain.pose(found.q, "lower").translation();
    EXPECT_LE((upper - Eigen::Vector3d(0, 0, upper.z())).norm(), tolerance) << is_redundant;
    EXPECT_LE((lower - Eigen::Vector3d(0, 0, lower.z())).norm(), tolerance) << is_redundant;
    EXPECT_NEAR(std::abs(upper.z()), 0.5, tolerance);
  }
}

/// A particle in a bowl z >= x^2 / 2, under a force along z.
Model bowl(double force) {
  return System<2>(
             {"x", "z"}, [](auto, const auto&, const auto& v) { return (v[0] * v[0] + v[1] * v[1]) / 2; },
             [force](auto, const auto&, const auto&) { return Eigen::Vector2d(0, force); })
      .unilateral("bowl", [](auto, const auto& q) { return q[1] - q[0] * q[0] / 2; });
}

TEST(Equilibrium, OfAContactCarriesTheWeight) {
  const State found = equilibrium(bowl(-g), {0, {0.6, 0.18}, {0, 0}});
  EXPECT_NEAR(found.q[0], 0, tolerance);
  EXPECT_NEAR(found.q[1], 0, tolerance);
  EXPECT_NEAR(found.multipliers[0], g, 1e-12);
}

TEST(Equilibrium, IsRefusedWhereAContactWouldLiftOff) {
  try {
    equilibrium(bowl(g), {0, {0.6, 0.18}, {0, 0}, ActiveSet{0}});
    FAIL() << "no exception";
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("the constraints bowl would not hold there"), std::string::npos)
        << error.what();
  }
}

TEST(Equilibrium, IsRefusedWithTheResidualWhereThereIsNone) {
  const Model falling =
      System<1>({"x"}, [](auto, const auto& q, const auto& v) { return v[0] * v[0] / 2 - g * q[0]; });
  try {
    equilibrium(falling, {0, {0.0}, {0.0}});
    FAIL() << "no exception";
  } catch (const NumericalError& error) {
    EXPECT_EQ(std::string(error.what()),
              "no equilibrium is found: after 1 iterations of Newton's method the accelerations are 1 of "
              "their terms, where at most 1e-10 is allowed, at t = 0, x = 0, x_dot = 0; another guess may "
              "help");
  }
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::equilibrium_test
