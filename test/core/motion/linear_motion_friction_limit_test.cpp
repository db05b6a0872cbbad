// The search for the loss of grip misses none: random motions, sampled densely.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "motion/linear_motion.hpp"
#include "support/case_count.hpp"

namespace hybrid_sphere::linear_motion_friction_limit_test {
namespace {

constexpr double horizon = 8;

/// A motion on a coulomb turntable, whose reaction turns with drag, a spring and a push.
class RandomMotion {
 public:
  explicit RandomMotion(unsigned seed) : engine_(seed) {
    forces_.gravity.head<2>() = vector(0.5);
    if (chance(0.5)) forces_.wrench.torque = Vector3d(number(0.5), number(0.5), 0);
    if (chance(0.6)) forces_.drag.translational = std::abs(number(1));
    if (chance(0.6)) forces_.drag.rotational = 0.02 * std::abs(number(1));
    if (chance(0.6)) forces_.spring = {vector(2), std::abs(number(8))};
    material_.turntable_rate = chance(0.8) ? number(4) : 0;
    position_ = vector(2);
    velocity_ = vector(2);
  }

  LinearMotion on(double friction) {
    material_.friction = friction;
    return LinearMotion::rolling(dynamics(), material_, position_, velocity_, NormalSpin(0));
  }
  Dynamics dynamics() const { return {Sphere({2, 0.25, 0.15}), forces_}; }
  bool chance(double part) { return std::uniform_real_distribution<>(0, 1)(engine_) < part; }
  double number(double size) { return std::uniform_real_distribution<>(-size, size)(engine_); }

 private:
  Vector2d vector(double size) { return {number(size), number(size)}; }

  std::mt19937 engine_;
  scene::Forces forces_;
  scene::Material material_{scene::Law::coulomb};
  Vector2d position_;
  Vector2d velocity_;
};

// The limit is put between the reactions of the motion itself: just under a maximum the loss is short before
// it.
TEST(LinearMotionGrip, IsLostAtTheFirstTimeAtWhichTheReactionExceedsTheLimit) {
  const auto cases = static_cast<unsigned>(testing::case_count(200));
  unsigned lost = 0;
  for (unsigned seed = 0; seed < cases; ++seed) {
    RandomMotion random(seed);
    const Dynamics dynamics = random.dynamics();
    LinearMotion free = random.on(1e9);
    constexpr int samples = 4000;
    double largest = 0;
    for (int i = 0; i <= samples; ++i)
      largest = std::max(largest, free.reaction(horizon * i / samples).norm());
    const double at_start = free.reaction(0).norm();
    // Half of the limits are a part in a thousand or less under the largest reaction.
    const double part =
        random.chance(0.5) ? 1 - 1e-3 * std::abs(random.number(1)) : std::abs(random.number(1));
    const double limit = std::max(at_start * (1 + 1e-6), part * largest);
    LinearMotion motion =
        random.on(limit * dynamics.mass / dynamics.normal_force);  // the reaction is lambda/m
    const double end = motion.end_before(horizon);
    for (int i = 0; i <= samples && horizon * i / samples < end; ++i) {
      const double reaction = free.reaction(horizon * i / samples).norm();
      ASSERT_LE(reaction, limit * (1 + 1e-13)) << "seed " << seed << ", t = " << horizon * i / samples;
    }
    if (end == never) continue;
    ++lost;
    EXPECT_NEAR(free.reaction(end).norm(), limit, 1e-12 * limit) << seed;
  }
  EXPECT_GE(lost, cases / 3);
}

// Difference quotients of the square: off by the fourth derivative times step^2/12, and by rounding. The
// bound is closest where what it begins with happens to be small.
TEST(LinearMotionGrip, HasABoundOnTheCurvatureOfTheReactionsSquare) {
  double closest = 0;
  for (unsigned seed = 0; seed < 4000; ++seed) {
    RandomMotion random(seed);
    const LinearMotion motion = random.on(1e9);
    const double span = 0.05 + std::abs(random.number(0.5));
    double from = 0;
    for (int i = 1; i < 64; ++i) {
      const double other = 2. * i / 64;
      if (motion.reaction_bend(other, other + span) < motion.reaction_bend(from, from + span)) from = other;
    }
    const double bound = motion.reaction_bend(from, from + span);
    const auto square = [&](double tau) { return motion.reaction(tau).squaredNorm(); };
    constexpr double step = 1e-3;
    for (int i = 0; i <= 8; ++i) {
      const double tau = from + step + (span - 2 * step) * i / 8;
      const double bend = (square(tau - step) - 2 * square(tau) + square(tau + step)) / (step * step);
      const double rounding = 1e-14 * square(tau) / (step * step);
      ASSERT_LE(std::abs(bend), bound * (1 + 1e-5) + rounding) << "seed " << seed << ", tau = " << tau;
      if (bound > 0) closest = std::max(closest, std::abs(bend) / bound);
    }
  }
  EXPECT_GT(closest, 0.9);
}

}  // namespace
}  // namespace hybrid_sphere::linear_motion_friction_limit_test
