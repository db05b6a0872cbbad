// Constraints that say the same twice, all along a motion: where the terms of their derivatives are large and
// cancel, the roundings that are left are no contradiction.

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>

#include "core/mechanics/particle.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::redundant_motion_test {
namespace {

using testing::vector;

constexpr int steps = 1000;

/// Free motion in many steps of equal length.
Options in_steps(double duration) {
  Options options;
  options.max_step = duration / steps;
  options.max_steps = 4 * steps;
  return options;
}

/// A body in the plane that nothing accelerates, turning fast.
System<3> turning_body() {
  return {{"x", "y", "theta"}, [](auto, const auto&, const auto& v) { return v.dot(v) / 2; }};
}

constexpr double climb = 0.7;  // y'

const auto climbing = [](auto, const auto&, const auto& v) { return v[1] - climb; };

/// The same, and 0 as a sum of terms of the size of x'; those of its derivative are of the size of x' theta'.
const auto climbing_and_turning = [](auto, const auto& q, const auto& v) {
  using std::cos, std::sin;
  return v[1] - climb + v[0] * (sin(2 * q[2]) - 2 * sin(q[2]) * cos(q[2]));
};

TEST(RedundantConstraints, DoNotContradictEachOtherInLargeTermsThatCancel) {
  for (const double rate : {0.0, 1.0, 1e2, 1e4}) {
    System<3> body = turning_body();
    body.constrain("climbing", climbing, always()).constrain("turning", climbing_and_turning, always());
    body.constrain(
        "both",
        [](auto t, const auto& q, const auto& v) {
          return climbing_and_turning(t, q, v) - 2 * climbing(t, q, v);
        },
        always());
    const double duration = 1;
    const Solution solution =
        solve(body, {0, vector({0, 0, 1e3}), vector({1, climb, rate})}, duration, in_steps(duration));
    ASSERT_EQ(solution.status().stop, Stop::reached_end)
        << "rate " << rate << ": " << solution.status().message;
    EXPECT_GE(solution.steps(), steps) << "rate " << rate;
    const State end = solution.at(duration);
    // Each step rounds the place, and puts some roundings of terms of size 2 on the velocities.
    EXPECT_NEAR(end.q[0], 1, 16 * steps * DBL_EPSILON) << "rate " << rate;
    EXPECT_NEAR(end.v[1], climb, 16 * DBL_EPSILON) << "rate " << rate;
  }
}

/// An upright disk of radius R: x, y, direction, angle of rolling.
System<4> disk(double R) {
  return {{"x", "y", "theta", "phi"}, [=](auto, const auto&, const auto& v) {
            return (v[0] * v[0] + v[1] * v[1] + R * R * (v[2] * v[2] / 4 + v[3] * v[3] / 2)) / 2;
          }};
}

/// x' = R phi' cos theta, y' = R phi' sin theta.
auto rolling(double R) {
  return [=](auto t, const auto& q, const auto& v) {
    using std::cos, std::sin;
    return Eigen::Matrix<decltype(t), 2, 1>(v[0] - R * v[3] * cos(q[2]), v[1] - R * v[3] * sin(q[2]));
  };
}

/// At x = y = 0 in the direction theta, both angles changing at `rate`.
Initial start_of_rolling(double R, double rate, double theta) {
  return {0, vector({0, 0, theta, 0}),
          vector({R * rate * std::cos(theta), R * rate * std::sin(theta), rate, rate})};
}

/// A circle of radius R phi'/theta' = R in a time of 2 pi/theta', held by R rate^2 inwards.
/// @param rows   of the multipliers: what each of them pushes at x and y (2 x g)
void expect_circle(const System<4>& system, double R, double rate, const Matrix& rows) {
  constexpr int turns = 10;  // whole ones, at the end of which the disk is where it was
  constexpr double theta = 1e3;
  const double duration = 2 * M_PI * turns / rate;
  const Options options = in_steps(duration);
  const Solution solution = solve(system, start_of_rolling(R, rate, theta), duration, options);
  ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
  EXPECT_GE(solution.steps(), steps);
  const State end = solution.at(duration);
  // Off by the accuracy, relative to the way that the disk goes in a turning time: not more than the circle.
  EXPECT_LE(end.q.head<2>().norm(), options.accuracy * 2 * M_PI * R);
  const double centripetal = R * rate * rate;
  const Eigen::Vector2d inwards(-std::sin(theta), std::cos(theta));
  EXPECT_LE((rows * end.multipliers - centripetal * inwards).norm(),
            options.accuracy * 2 * M_PI * centripetal);
}

TEST(RedundantConstraints, OfADiskThatRollsFastKeepItOnItsCircle) {
  for (const double R : {1e-3, 1.0, 1e3}) {
    for (const double rate : {1.0, 1e3}) {
      SCOPED_TRACE(::testing::Message() << "R = " << R << ", rate " << rate);
      System<4> twice = disk(R);
      twice.constrain("once", rolling(R), always()).constrain("twice", rolling(R), always());
      Matrix rows(2, 5);
      rows << 1, 0, 1, 0, 1, 0, 1, 0, 1, 1;
      expect_circle(twice, R, rate, rows.leftCols(4));
      twice.constrain(
          "sum",
          [=](auto t, const auto& q, const auto& v) {
            const auto f = rolling(R)(t, q, v);
            return f[0] + f[1];
          },
          always());
      expect_circle(twice, R, rate, rows);
    }
  }
}

// Within a step, where the velocities are off the constraints by its errors, one says a little else than the
// other; where they hold there is no contradiction.
TEST(RedundantConstraints, InAnotherFrameDoNotContradict) {
  for (const double rate : {1.0, 1e3}) {
    SCOPED_TRACE(::testing::Message() << "rate " << rate);
    const double R = 1, theta = 1e3;
    System<4> twice = disk(R);
    twice.constrain("fixed", rolling(R), always());
    twice.constrain(
        "turned",
        [=](auto t, const auto& q, const auto& v) {
          using std::cos, std::sin;
          return Eigen::Matrix<decltype(t), 2, 1>(v[0] * cos(q[2]) + v[1] * sin(q[2]) - R * v[3],
                                                  v[1] * cos(q[2]) - v[0] * sin(q[2]));
        },
        always());
    Matrix rows(2, 4);
    rows << 1, 0, std::cos(theta), -std::sin(theta), 0, 1, std::sin(theta), std::cos(theta);
    expect_circle(twice, R, rate, rows);
  }
}

// "faster" wants an acceleration that "climbing" does not allow; that is no rounding, however fast the body
// turns.
TEST(RedundantConstraints, StillTellAContradictionInAFastMotion) {
  System<3> body = turning_body();
  body.constrain("climbing", climbing, always());
  body.constrain(
      "faster", [](auto t, const auto& q, const auto& v) { return climbing_and_turning(t, q, v) - 1e-3 * t; },
      always());
  const Solution solution = solve(body, {0, vector({0, 0, 1e3}), vector({1, climb, 1e4})}, 1);
  EXPECT_EQ(solution.status().stop, Stop::inconsistent) << solution.status().message;
  EXPECT_EQ(solution.status().time, 0);
  EXPECT_NE(solution.status().message.find("climbing, faster"), std::string::npos)
      << solution.status().message;
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::redundant_motion_test
