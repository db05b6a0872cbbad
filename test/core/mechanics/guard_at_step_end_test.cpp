// A guard may turn, or change its sign, just where a step of the integration ends.
#include <gtest/gtest.h>

#include <cmath>

#include "core/mechanics/particle.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::guard_at_step_end_test {
namespace {

using testing::particle, testing::vector;

/// A uniform motion over strips of y, of length 1/2 each: it stops along x on every other one. Without forces
/// the first step is a hundredth of the duration, and guards and their rates follow y exactly.
Solution across_strips(double y, double speed, double duration) {
  System<2> system = particle();
  system.constrain(
      "still", [](auto, const auto&, const auto& v) { return v[0]; }, while_positive([](auto, const auto& q) {
        using std::sin;
        return sin(2 * M_PI * q[1]);
      }));
  return solve(system, {0, vector({0, y}), vector({1, speed})}, duration);
}

TEST(GuardAtStepEnd, AGuardThatTurnsAtTheEndOfAStepChangesNothing) {
  struct Case {
    double y, speed, duration;
    std::size_t switches;
  };
  // All have y = -1/4 at a hundredth of the duration, where the guard is least.
  for (const auto& [y, speed, duration, switches] :
       {Case{-0.45, 1, 20, 40}, Case{-0.475, 0.75, 30, 45}, Case{-0.4, 0.75, 20, 30}}) {
    SCOPED_TRACE(::testing::Message() << "y = " << y << ", y' = " << speed);
    const Solution solution = across_strips(y, speed, duration);
    ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
    EXPECT_EQ(solution.switches().size(), switches);
    EXPECT_NEAR(solution.at(duration).q[1], y + speed * duration, 1e-12);
  }
}

TEST(GuardAtStepEnd, AGuardThatIsRoundingAllTheWayDoesNotEndTheMotion) {
  const System<2> system = testing::on_a_hill();
  const Solution whole = solve(system, {0, vector({0, 1}), vector({2, 0})}, 2);
  ASSERT_EQ(whole.status().stop, Stop::reached_end) << whole.status().message;
  for (int i = 0; i < 40; ++i) {
    const State from = whole.at(0.6 + 0.7 * i / 40);
    if (from.active.empty()) continue;
    const Solution solution = solve(system, {from.time, from.q, from.v}, 0.01);
    ASSERT_EQ(solution.status().stop, Stop::reached_end)
        << "t = " << from.time << ": " << solution.status().message;
    const State there = whole.at(from.time + 0.01);
    EXPECT_LT((solution.at(there.time).q - there.q).norm(), 1e-6) << "t = " << from.time;
  }
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::guard_at_step_end_test
