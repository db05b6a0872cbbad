#include "motion/normal_spin.hpp"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>

#include "core/motion/integrated.hpp"

namespace hybrid_sphere::testing::normal_spin_test {
namespace {

// omega_3' with the friction in a given sense.
double followed(double omega_3, double torque_rate, double drag, double friction, double time) {
  const auto slope = [&](const std::array<double, 1>& y, double) {
    return std::array<double, 1>{torque_rate - drag * y[0] - friction};
  };
  return integrated<1>({omega_3}, time, slope)[0];
}

TEST(NormalSpin, IsExactlyConstantWhereNothingActs) {
  EXPECT_EQ(NormalSpin(0.1).at(1e9), 0.1);
  EXPECT_EQ(NormalSpin(0.1, 0, 0, 0, 3).at(1e9), 0.1);
  EXPECT_TRUE(NormalSpin(0.1, 0, 0, 0, 3).constant());
  EXPECT_TRUE(NormalSpin(2, 1, 0.5, 0, 3).constant());    // the torque balances the drag
  EXPECT_TRUE(NormalSpin(3, 0.5, 0, 0.6, 3).constant());  // held by the ground
  EXPECT_EQ(NormalSpin(3, 0.5, 0, 0.6, 3).kink(), never);
}

TEST(NormalSpin, SolvesItsEquation) {
  const NormalSpin spin(5, 0.3, 0.7, 0.4, 1);
  ASSERT_GT(spin.kink(), 1.5);
  for (const double time : {0.0, 0.3, 1.5}) {
    const double expected = followed(5, 0.3, 0.7, 0.4, time);
    EXPECT_NEAR(spin.at(time), expected, 10 * integration_error * 5);
    EXPECT_NEAR(spin.derivative(time), 0.3 - 0.7 * expected - 0.4, 10 * integration_error * 5);
  }
}

TEST(NormalSpin, SticksToTheGroundThatCanHoldIt) {
  for (const double drag : {0.0, 0.01, 3.0}) {
    const NormalSpin spin(-4, 0.2, drag, 0.9 + 0.5 * drag, 0.5);
    ASSERT_LT(spin.kink(), never);
    // Just before it the rate of the ground is reached, up to the rounding of the time.
    const double before = spin.kink() * (1 - 4 * DBL_EPSILON);
    EXPECT_NEAR(spin.at(before), 0.5, 16 * DBL_EPSILON * (4 + spin.kink() * (2 + 6 * drag)));
    EXPECT_EQ(spin.at(spin.kink()), 0.5);
    EXPECT_EQ(spin.at(100 * spin.kink()), 0.5);
    EXPECT_EQ(spin.derivative(spin.kink()), 0);
  }
}

TEST(NormalSpin, PassesTheGroundThatCannotHoldIt) {
  const NormalSpin spin(-4, 2, 0.1, 0.5, 1);
  ASSERT_LT(spin.kink(), never);
  EXPECT_NEAR(followed(-4, 2, 0.1, -0.5, spin.kink()), 1, 100 * integration_error);
  EXPECT_NEAR(spin.at(spin.kink() + 2), followed(1, 2, 0.1, 0.5, 2), 100 * integration_error);
}

TEST(NormalSpin, StartsFromTheGroundsRateThatDoesNotHoldIt) {
  const NormalSpin spin(1, -2, 0.1, 0.5, 1);
  EXPECT_EQ(spin.kink(), never);
  EXPECT_NEAR(spin.at(2), followed(1, -2, 0.1, -0.5, 2), 100 * integration_error);
}

TEST(NormalSpin, LosesNothingWhenDragIsTiny) {
  const NormalSpin without(4, 0.2, 0, 0.9, 0.5);
  const NormalSpin with(4, 0.2, 1e-300, 0.9, 0.5);
  EXPECT_EQ(with.kink(), without.kink());
  EXPECT_EQ(with.kink(), 3.5 / 0.7);
  EXPECT_EQ(with.at(1), without.at(1));
}

}  // namespace
}  // namespace hybrid_sphere::testing::normal_spin_test
