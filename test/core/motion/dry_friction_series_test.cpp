#include "motion/dry_friction_series.hpp"

#include <gtest/gtest.h>

#include <cfloat>
#include <random>
#include <vector>

#include "core/motion/same_state.hpp"

namespace hybrid_sphere::testing::dry_friction_series_test {
namespace {

/// A slide down a slope. Its slip is used up, if at all, after the drive has turned it.
DryFrictionMotion slide(double friction, const Vector2d& slip, double pull) {
  scene::Forces forces;
  forces.gravity.x() = pull;
  scene::Material ground(scene::Law::coulomb);
  ground.friction = friction;
  const Dynamics dynamics(Sphere({1, 0.1, 0.06}), forces);
  return DryFrictionMotion::sliding(dynamics, ground, {3, -2}, {1, 0.5}, slip, NormalSpin(2));
}

struct Slide {
  const char* name;
  double friction;
  Vector2d slip;
  double pull;
};
const Slide slides[] = {
    {"faster and faster", 0.05, {1, 2}, 3},       {"to rest", 0.5, {1, 2}, 1},
    {"turned round quickly", 0.3, {-2, 1e-6}, 1}, {"turned round at once", 0.05, {-2, 1e-30}, 3},
    {"slowly", 0.3, {1e-3, 2e-3}, 0.5},
};

void expect_near(const MotionState& a, const MotionState& b, const char* name, double tau) {
  const double speed = b.center.velocity.norm() + b.contact_velocity.norm() + 3;
  EXPECT_LE((a.center.position - b.center.position).norm(), 8 * DBL_EPSILON * (b.center.position.norm() + 4))
      << name << ", " << tau;
  EXPECT_LE((a.center.velocity - b.center.velocity).norm(), 16 * DBL_EPSILON * speed) << name << ", " << tau;
  EXPECT_LE((a.contact_velocity - b.contact_velocity).norm(), 16 * DBL_EPSILON * speed)
      << name << ", " << tau;
  EXPECT_LE((a.angular_velocity - b.angular_velocity).norm(), 16 * DBL_EPSILON * speed / 0.1)
      << name << ", " << tau;
}

TEST(DryFrictionSeries, IsTheMotionToRounding) {
  for (const Slide& c : slides) {
    DryFrictionMotion motion = slide(c.friction, c.slip, c.pull);
    DryFrictionMotion same = motion;
    DryFrictionSeries series;
    series.begin(motion, 0.1);
    const double end = std::min(5.0, motion.end());
    for (int i = 1; i <= 3000; ++i) {
      const double tau = end * i / 3000;
      expect_near(series.at(tau), same.at(tau), c.name, tau);
    }
    if (motion.end() < never) {
      EXPECT_EQ(series.at(motion.end()).contact_velocity, Vector2d::Zero()) << c.name;
    }
  }
}

TEST(DryFrictionSeries, DoesNotDependOnTheTimesBefore) {
  std::minstd_rand random(5);
  for (const Slide& c : slides) {
    DryFrictionMotion motion = slide(c.friction, c.slip, c.pull);
    const double end = std::min(5.0, motion.end());
    DryFrictionSeries often;
    often.begin(motion, 0.1);
    for (int i = 0; i < 300; ++i) {
      const double tau = std::uniform_real_distribution<double>(0, end)(random);
      DryFrictionSeries once;
      once.begin(motion, 0.1);
      expect_same(often.at(tau), once.at(tau), c.name + (" at " + std::to_string(tau)));
    }
  }
}

// A slip that is far faster than the sphere.
TEST(DryFrictionSeries, LosesNothingNearTheBeginning) {
  DryFrictionMotion motion = slide(0.1, {1e6, 2e6}, 1.5);
  DryFrictionMotion same = motion;
  DryFrictionSeries series;
  series.begin(motion, 10);
  const Vector2d start = same.at(0).center.position;
  for (const double tau : {1e-9, 1e-6, 1e-3, 1.0}) {
    const Vector2d exact = same.at(tau).center.position;
    const double tolerance = 16 * DBL_EPSILON * (3e6 * tau) + DBL_EPSILON * (exact.norm() + start.norm());
    EXPECT_LE((series.at(tau).center.position - exact).norm(), tolerance) << tau;
  }
}

// Towards the end the direction of w changes by a power of the time that is left: in the last intervals the
// motion itself is evaluated.
TEST(DryFrictionSeries, LeavesTheLastMomentsToTheMotion) {
  DryFrictionMotion motion = slide(0.5, {1, 2}, 1);
  ASSERT_LT(motion.end(), never);
  DryFrictionSeries series;
  series.begin(motion, 0.1);
  for (const double left : {1e-9, 1e-12}) {
    const double tau = motion.end() - left;
    EXPECT_EQ(series.at(tau).contact_velocity, motion.at(tau).contact_velocity) << left;
    EXPECT_EQ(series.at(tau).center.position, motion.at(tau).center.position) << left;
  }
}

// Where they do not converge, they say so.
TEST(DryFrictionMotion, ExpansionConvergesWithItsLength) {
  DryFrictionMotion motion = slide(0.05, {1, 2}, 3);
  const double from = 0.5;
  double before = never;
  for (double width = 0.4; width > 0.01; width *= 0.5) {
    const StatePolynomial expansion = motion.expand(from, width);
    const MotionState exact = motion.at(from + width);
    const double error = (expansion.at(from + width).center.velocity - exact.center.velocity).norm();
    EXPECT_LE(error, 2 * polynomials::left_out<12>(expansion.powers, 2, 2) + 8 * DBL_EPSILON) << width;
    EXPECT_LE(error, std::max(before * 0x1p-10, 8 * DBL_EPSILON)) << width;
    before = error;
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::dry_friction_series_test
