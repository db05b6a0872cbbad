// Constraints that are nearly all one velocity's.
#include <gtest/gtest.h>

#include <cmath>

#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::tied_velocity_test {
namespace {

// A skate that turns at a constant rate, v = (cos t, sin t): its force is -1 all the time, also while it is
// nearly along an axis.
TEST(TiedVelocity, OfASkateNearAnAxisHasItsForce) {
  System<3> skate({"x", "y", "angle"}, [](auto, const auto&, const auto& v) { return v.squaredNorm() / 2; });
  skate.constrain(
      "blade",
      [](auto, const auto& q, const auto& v) {
        using std::cos, std::sin;
        return v[0] * sin(q[2]) - v[1] * cos(q[2]);
      },
      always());
  const Solution motion = solve(skate, {0, {0, 0, 0}, {1, 0, 1}}, 1);
  for (const double t : {0.0, 1e-12, 1e-9, 1e-8, 3e-8, 1e-7, 1e-6, 1e-4, 1e-2}) {
    const State state = motion.at(t);
    EXPECT_NEAR(state.multipliers[0], -1, 1e-14) << t;
    EXPECT_NEAR(state.v[0], std::cos(t), 1e-15) << t;
    EXPECT_NEAR(state.v[1], std::sin(t), 1e-15 * (1 + t)) << t;
  }
}

// A torque on a wheel without much mass moves the car: m x'' = torque / r.
TEST(TiedVelocity, OfALightWheelIsThatOfTheCar) {
  for (const double light : {1e-6, 1e-12, 1e-16}) {
    System<2> car(
        {"x", "angle"},
        [light](auto, const auto&, const auto& v) { return (v[0] * v[0] + light * v[1] * v[1]) / 2; },
        [](double, const auto&, const auto&) { return Eigen::Vector2d(0, 1); });
    car.constrain(
        "rolling", [](auto, const auto&, const auto& v) { return v[0] - v[1]; }, always());
    const Solution motion = solve(car, {0, {0, 0}, {0, 0}}, 1);
    const State end = motion.at(1);
    EXPECT_NEAR(end.v[0], 1 / (1 + light), 1e-13) << light;
    EXPECT_NEAR(end.v[1], end.v[0], 1e-13) << light;
    EXPECT_NEAR(end.multipliers[0], 1 / (1 + light), 1e-12) << light;
  }
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::tied_velocity_test
