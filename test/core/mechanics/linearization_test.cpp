#include "hybrid_sphere/mechanics/linearization.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/mechanics/particle.hpp"

namespace hybrid_sphere::mechanics::linearization_test {
namespace {

State state_of(const Model& model, const Vector& q, const Vector& v) {
  return solve(model, {0, q, v}, 0).at(0);
}

/// A torque turns it, in units of its inertia, and friction slows it.
Model pendulum(const Vector& input) {
  const double torque = input[0];
  return System<1>(
      {"angle"},
      [](auto, const auto& q, const auto& v) {
        using std::cos;
        return v[0] * v[0] / 2 + 9.81 * cos(q[0]);
      },
      [torque](auto, const auto&, const auto& v) { return torque - 0.5 * v[0]; });
}

TEST(Linearization, OfAPendulumIsItsFormula) {
  for (const double angle : {0.0, 0.3, 2.0, -40.0}) {
    const Linearization found = linearize(pendulum, {0.7}, state_of(pendulum({0.7}), {angle}, {1.5}));
    const Eigen::Matrix2d A = (Eigen::Matrix2d() << 0, 1, -9.81 * std::cos(angle), -0.5).finished();
    EXPECT_LE((found.A - A).cwiseAbs().maxCoeff(), 1e-11 * (1 + std::abs(angle))) << angle;
    EXPECT_LE((found.B - Eigen::Vector2d(0, 1)).cwiseAbs().maxCoeff(), 1e-11);
    EXPECT_NEAR(found.rate[1], -9.81 * std::sin(angle) + 0.7 - 0.75, 1e-14);
  }
}

// A skate at the speed u along itself, turning at the rate w: v is bound to its direction.
TEST(Linearization, IsOnTheConstraintsThatHold) {
  const Model skate =
      System<3>({"x", "y", "angle"}, [](auto, const auto&, const auto& v) { return v.squaredNorm() / 2; })
          .constrain(
              "blade",
              [](auto, const auto& q, const auto& v) {
                using std::cos, std::sin;
                return v[1] * cos(q[2]) - v[0] * sin(q[2]);
              },
              always());
  constexpr double u = 2, w = 3;
  const Linearization found = linearize(skate, state_of(skate, {0, 0, 0}, {u, 0, w}));
  // v' = w u (-sin, cos): dv'/dw = u (-sin, cos), dv'/du = w (-sin, cos), dv'/dangle = -w u (cos, sin)
  EXPECT_NEAR(found.A(3, 2), -w * u, 1e-10);
  EXPECT_NEAR(found.A(4, 3), w, 1e-10);
  EXPECT_NEAR(found.A(4, 5), u, 1e-10);
  EXPECT_NEAR(found.A(5, 5), 0, 1e-10);
  EXPECT_EQ(found.B.cols(), 0);
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::linearization_test
