// Chaplygin's ball by the general engine: against 25 digits of another formulation, and for long.

#include <gtest/gtest.h>

#include <algorithm>

#include "core/catalogue/own_references.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"

namespace hybrid_sphere::mechanics::catalogue::testing::chaplygin_ball_test {
namespace {

double largest(const Vector& vector) { return vector.cwiseAbs().maxCoeff(); }

ReferenceSystem reference() { return own_reference("chaplygin_ball", "chaplygin_ball"); }

// Lengths, angles and their rates are of order 1, multipliers below 1.
TEST(ChaplyginBallSolved, IsItsReferenceToTheAccuracyAskedFor) {
  const ReferenceSystem system = reference();
  for (const Model& model : {system.example.model, system.example.by_hand}) {
    for (const double accuracy : {1e-3, 1e-6, 1e-10, 1e-12}) {
      Options options;
      options.accuracy = accuracy;
      const Solution solution = solve(model, system.example.initial, system.duration(), options);
      ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
      ASSERT_EQ(solution.switches().size(), 1u);
      const Switch& change = solution.switches()[0];
      EXPECT_LE(largest(change.v_after - system.impulse.v_after), accuracy);
      EXPECT_LE(largest(change.multipliers - system.impulse.multipliers), accuracy);
      for (const ReferenceState& state : system.states) {
        const State found = solution.at(state.time);
        EXPECT_LE(largest(found.q - state.q), accuracy) << "t = " << state.time;
        EXPECT_LE(largest(found.v - state.v), accuracy) << "t = " << state.time;
        EXPECT_LE(largest(found.multipliers - state.multipliers), accuracy) << "t = " << state.time;
      }
    }
  }
}

TEST(ChaplyginBallSolved, KeepsItsInvariantsOverAThousandCharacteristicTimes) {
  const ReferenceSystem system = reference();
  const double accuracy = 1e-9, duration = 1000 * entry("chaplygin_ball").characteristic_time;
  Options options;
  options.accuracy = accuracy;
  const Solution solution = solve(system.example.by_hand, system.example.initial, duration, options);
  ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
  const State first = solution.at(system.t_switch);
  for (const Invariant& invariant : system.example.invariants) {
    const double value = invariant.value(first);
    double drift = 0;
    for (int i = 1; i <= 100; ++i) {
      drift = std::max(
          drift, std::abs(invariant.value(solution.at(system.t_switch + (duration - 1) * i / 100)) - value));
    }
    // All of order 1.
    EXPECT_LE(drift, accuracy) << invariant.name;
  }
  double residual = 0;
  for (int i = 1; i <= 100; ++i)
    residual = std::max(residual, solution.at((duration - 1) * i / 100 + 0.5).residual);
  // f is the sum of seven products of numbers below 2, of rounded q: 8 roundings each.
  EXPECT_LE(residual, 7 * 8 * 2 * 0x1p-53);
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::catalogue::testing::chaplygin_ball_test
