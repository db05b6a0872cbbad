// Coordinates much larger than their changes: their rounding is in the forces, and no step gets rid of it.

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>

#include "core/mechanics/particle.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::large_angle_test {
namespace {

using testing::accurate, testing::vector;

constexpr double mass = 2, inertia = 0.75, arm = 0.4;

/// Chaplygin's sleigh: the blade at (x, y), the mass centre ahead of it.
Solution sleigh(double theta, double accuracy) {
  System<3> system({"x", "y", "theta"}, [](auto, const auto& q, const auto& v) {
    using std::cos, std::sin;
    const auto x_dot = v[0] - arm * v[2] * sin(q[2]);
    const auto y_dot = v[1] + arm * v[2] * cos(q[2]);
    return (mass * (x_dot * x_dot + y_dot * y_dot) + inertia * v[2] * v[2]) / 2;
  });
  system.constrain(
      "blade",
      [](auto, const auto& q, const auto& v) {
        using std::cos, std::sin;
        return v[1] * cos(q[2]) - v[0] * sin(q[2]);
      },
      from(0.5));
  const double c = std::cos(theta), s = std::sin(theta);
  Options options = accurate(accuracy);
  options.max_steps = 100000;
  return solve(system, {0, vector({0, 0, theta}), vector({c - 0.8 * s, s + 0.8 * c, 1.5})}, 4, options);
}

TEST(LargeAngle, TakesHardlyMoreSteps) {
  for (const double accuracy : {1e-3, 1e-6, 1e-9}) {
    const std::uint64_t steps = sleigh(0, accuracy).steps();
    for (const double theta : {1e3, 1e5, 1e7, -1e7}) {
      const Solution solution = sleigh(theta, accuracy);
      EXPECT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
      // Where theta rounds by more than the accuracy, steps are as long as its rounding allows.
      const double most = std::abs(theta) * DBL_EPSILON > accuracy ? 5 : 3;
      EXPECT_LE(static_cast<double>(solution.steps()), most * static_cast<double>(steps))
          << "theta = " << theta << ", accuracy " << accuracy;
    }
  }
}

// Turned by theta it is the same motion, to the accuracy and to the rounding of theta: at each of the steps,
// carried on by the speed of about 1 for 4 s.
TEST(LargeAngle, LeadsToTheSamePlace) {
  constexpr double accuracy = 1e-9;
  const State expected = sleigh(0, accuracy).at(4);
  for (const double theta : {1e3, 1e5, 1e7}) {
    const Solution solution = sleigh(theta, accuracy);
    ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
    const State found = solution.at(4);
    const double rounding = static_cast<double>(solution.steps()) * DBL_EPSILON * theta;
    const double allowed = 4 * (2 * accuracy + rounding);
    const double c = std::cos(theta), s = std::sin(theta);
    const Eigen::Vector2d place(c * expected.q[0] - s * expected.q[1], s * expected.q[0] + c * expected.q[1]);
    EXPECT_LE((found.q.head<2>() - place).norm(), allowed) << "theta = " << theta;
    EXPECT_NEAR(found.q[2] - theta, expected.q[2], allowed) << "theta = " << theta;
    EXPECT_NEAR(found.energy, expected.energy, allowed * expected.energy) << "theta = " << theta;
  }
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::large_angle_test
