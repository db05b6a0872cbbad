// A guard that is 0 along the motion is looked at a little ahead. What lies there beyond the motion's own way
// does not end it.

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>

#include "core/mechanics/particle.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::look_ahead_test {
namespace {

using testing::level, testing::particle, testing::vector;

/// x = t, kept at 0.04 by a stop, in sight of 0.05; a motion along y = 0, the edge of a guard, which is
/// looked at in three instants up to 1e-4 of the duration ahead.
void expect_stopped(System<2> system) {
  system.constrain("edge", level, while_positive([](auto, const auto& q) { return q[1]; }));
  system.constrain(
      "stop", [](auto, const auto&, const auto& v) { return v[0]; },
      while_positive([](auto, const auto& q) { return q[0] - 0.04; }));
  const Solution solution = solve(system, {0, vector({0, 0}), vector({1, 0})}, 1000);
  ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
  ASSERT_EQ(solution.switches().size(), 1u);
  EXPECT_EQ(solution.switches()[0].applied, ActiveSet{system.constraints.size() - 1});
  EXPECT_NEAR(solution.switches()[0].time, 0.04, 4 * DBL_EPSILON);
  EXPECT_NEAR(solution.at(1000).q[0], 0.04, 4 * DBL_EPSILON);
}

TEST(LookAhead, DoesNotEndAMotionWhereAFunctionIsNotFiniteAhead) {
  expect_stopped({{"x", "y"}, [](auto, const auto& q, const auto& v) {
                    using std::pow;
                    return v.dot(v) / 2 + 0 * pow(0.05 - q[0], 2.5);
                  }});
}

TEST(LookAhead, DoesNotEndAMotionWhereTheMassVanishesAhead) {
  expect_stopped({{"x", "y"}, [](auto, const auto& q, const auto& v) {
                    auto mass = 1 + 0 * q[0];
                    if (q[0] > 0.05) mass = 0 * q[0];
                    return (v[0] * v[0] + mass * v[1] * v[1]) / 2;
                  }});
}

TEST(LookAhead, DoesNotEndAMotionWhereAConstraintLosesItsDirectionAhead) {
  System<2> system = particle();
  system.constrain(
      "line",
      [](auto, const auto& q, const auto& v) {
        auto factor = 1 + 0 * q[0];
        if (q[0] > 0.05) factor = 0 * q[0];
        return factor * v[1];
      },
      always());
  expect_stopped(system);
}

// y is held at 0 until t = 1; then y = (t - 1)^2/2. At t = 1 neither the guard's value nor its rate tells its
// sign: the motion over a part of the last step does, not over one of the whole duration, where it is over.
TEST(LookAhead, GoesNoFartherThanTheLastStep) {
  System<2> system = particle(-1);
  system.constrain("hold", level, between(0, 1));
  system.constrain(
      "stop", [](auto, const auto&, const auto& v) { return v[0]; },
      while_positive(
          [](auto t, const auto& q) { return 0.01 * q[1] - q[1] * q[1] - 0.0025 * (t - 1) * (t - 1); }));
  const Solution solution = solve(system, {0, vector({0, 0}), vector({1, 0})}, 1e7);
  ASSERT_EQ(solution.switches().size(), 4u);  // the hold's two, and the stop's
  EXPECT_EQ(solution.switches()[2].applied, ActiveSet{1});
  EXPECT_EQ(solution.switches()[2].time, 1);
  EXPECT_NEAR(solution.switches()[3].time, 1.1, 1e-12);
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::look_ahead_test
