// The part of a push along which a slip can begin.
#include "mechanics/movable_part.hpp"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>

#include "core/mechanics/particle.hpp"

namespace hybrid_sphere::mechanics::movable_part_test {
namespace {

using testing::vector;

/// Of a slip that can change along one direction only, as by 1/mass there.
Eigen::Matrix2d effect_along(double angle, double mass) {
  const Eigen::Vector2d way(std::cos(angle), std::sin(angle));
  return way * way.transpose() / mass;
}

TEST(MovablePart, IsTheWholePushIfTheSlipIsFree) {
  const Vector push = vector({3, -4});
  EXPECT_EQ(movable_part(Eigen::Matrix2d::Identity(), push), push);
  Eigen::Matrix2d nearly;  // directions that differ by 1e-3
  nearly << 1, 1, 1e-3, 2e-3;
  EXPECT_EQ(movable_part(nearly, push), push);
}

TEST(MovablePart, IsThatAlongTheOnlyDirection) {
  for (double angle = 0; angle < 6; angle += 0.7) {
    for (const double mass : {1e-6, 1.0, 1e6}) {
      const Eigen::Vector2d way(std::cos(angle), std::sin(angle));
      const Vector part = movable_part(effect_along(angle, mass), vector({3, -4}));
      EXPECT_LE((part - Vector(way.dot(Eigen::Vector2d(3, -4)) * way)).norm(), 32 * DBL_EPSILON) << angle;
    }
  }
}

TEST(MovablePart, IsThePushIfNothingMoves) {
  const Vector push = vector({0, 2});
  EXPECT_EQ(movable_part(Eigen::Matrix2d::Zero(), push), push);
  EXPECT_EQ(movable_part(effect_along(0, 1), push), push) << "across the only direction";
}

/// A block on a floor, pushed along x with a force that grows, on a rail at an angle to x.
System<3> block(double angle, double friction, double gravity) {
  System<3> block({"x", "y", "z"}, [=](auto t, const auto& q, const auto& v) {
    return v.squaredNorm() / 2 + t * q[0] - gravity * q[2];
  });
  block.unilateral("floor", [](auto, const auto& q) { return q[2]; });
  block.friction(
      "grip", [](auto t, const auto&, const auto& v) { return Eigen::Matrix<decltype(t), 2, 1>(v[0], v[1]); },
      friction, "floor");
  block.constrain(
      "rail",
      [=](auto, const auto&, const auto& v) { return v[0] * std::sin(angle) - v[1] * std::cos(angle); },
      always());
  return block;
}

// The rail takes what is across it: s'' = t cos(angle) - mu g from the instant at which that is positive.
TEST(MovablePart, IsTheDirectionInWhichABlockOnARailBeginsToSlide) {
  constexpr double friction = 0.1, gravity = 10, duration = 4;
  for (const double angle : {0.0, 0.4, -1.0}) {
    const Solution motion = solve(block(angle, friction, gravity), {0, {0, 0, 0}, {0, 0, 0}}, duration);
    ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
    const double begin = friction * gravity / std::cos(angle);
    ASSERT_EQ(motion.switches().size(), 1u) << angle;
    EXPECT_NEAR(motion.switches()[0].time, begin, 1e-9) << angle;
    const double after = duration - begin;
    const double way = std::cos(angle) * after * after * after / 6;
    const State end = motion.at(duration);
    EXPECT_NEAR(end.q[0], way * std::cos(angle), 1e-9 * way) << angle;
    EXPECT_NEAR(end.q[1], way * std::sin(angle), 1e-9 * way) << angle;
  }
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::movable_part_test
