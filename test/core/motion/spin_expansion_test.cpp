// Taylor polynomials of the angular velocity of every motion that has them.

#include <gtest/gtest.h>

#include <cfloat>
#include <string>

#include "motion/dry_friction_motion.hpp"
#include "motion/edge_slide.hpp"
#include "motion/linear_series.hpp"
#include "motion/straight_slide.hpp"

namespace hybrid_sphere::testing::spin_expansion_test {
namespace {

Dynamics dynamics_of(const Vector2d& gravity, double drag = 0, double stiffness = 0) {
  scene::Forces forces;
  forces.gravity.head<2>() = gravity;
  forces.wrench.torque = {0.01, -0.02, 0.003};
  forces.drag = {drag, 0.01 * drag};
  forces.spring = {{0.5, -0.2}, stiffness};
  return {Sphere({0.7, 0.2, 0.1264911064067352}), forces};
}

scene::Material coulomb(double friction, double resistance = 0) {
  scene::Material ground(scene::Law::coulomb);
  ground.friction = friction;
  ground.rolling_resistance = resistance;
  return ground;
}

scene::Material turntable(double rate) {
  scene::Material ground(scene::Law::rough);
  ground.belt = {0.3, -0.1};
  ground.turntable_rate = rate;
  ground.turntable_center = {0.4, 0.7};
  return ground;
}

/// @param terms  as many as are expected
void expect_expansion(Motion& motion, double middle, double half, int terms, const std::string& name) {
  polynomials::Powers<3> powers = polynomials::Powers<3>::Zero();
  ASSERT_EQ(motion.expand_spin(middle, half, powers), terms) << name;
  if (terms == 0) return;
  for (const double x : {-1.0, -0.7, -0.01, 0.0, 0.3, 1.0}) {
    Vector3d sum = Vector3d::Zero();
    for (int k = terms - 1; k >= 0; --k) sum = sum * x + powers.col(k);
    const Vector3d exact = motion.angular_velocity(middle + x * half);
    // Its parts, velocities over a radius of 0.2, are of the size of 10 rad/s.
    EXPECT_LE((sum - exact).norm(), 64 * DBL_EPSILON * (10 + exact.norm())) << name << ", " << x;
  }
}

TEST(SpinExpansion, OfLinearMotions) {
  const Vector2d slope(0.4, -0.3);
  for (const double rate : {0.0, 2.0}) {
    for (const Dynamics& dynamics :
         {dynamics_of(slope), dynamics_of(slope, 0.3), dynamics_of(slope, 0.3, 2)}) {
      const NormalSpin spin(3, dynamics.normal_spin, dynamics.rotational_drag, 0.7, 0.5);
      LinearMotion rolling = LinearMotion::rolling(dynamics, turntable(rate), {1.2, -0.7}, {0.8, 0.5}, spin);
      LinearMotion free =
          LinearMotion::free(dynamics, {1.2, -0.7}, {{0.8, 0.5}, {1, -2, 3}}, {0.4, 0.9}, spin);
      const bool is_parabola = rolling.fastest_rate() == 0;
      expect_expansion(rolling, 0.7, 0.15, is_parabola ? 2 : polynomials::size, "rolling");
      expect_expansion(free, 0.7, 0.15, free.fastest_rate() == 0 ? 2 : polynomials::size, "free");
      // Beyond the kink of omega_3.
      const double kink = spin.kink();
      ASSERT_LT(kink, 100);
      expect_expansion(rolling, kink + 0.2, 0.2, is_parabola ? 2 : polynomials::size, "rolling, later");
      LinearSeries series;
      series.begin(rolling);
      expect_expansion(series, 0.7, 0.15, is_parabola ? 2 : polynomials::size, "series");
    }
  }
}

// What has died out would be the rounding of it, times large powers.
TEST(SpinExpansion, IsNoneBeyondTheTimeInWhichTheMotionChanges) {
  const Dynamics dynamics = dynamics_of({0.4, -0.3}, 1e6);
  LinearMotion motion = LinearMotion::rolling(dynamics, turntable(0), {1.2, -0.7}, {0.8, 0.5}, NormalSpin(3));
  expect_expansion(motion, 1, 0.5, 0, "drag");
  expect_expansion(motion, 1, 0.9 / motion.fastest_rate(), polynomials::size, "drag");
}

TEST(SpinExpansion, OfDryFrictionAlongALine) {
  const Dynamics dynamics = dynamics_of({0, 0});
  scene::Forces none;
  const Dynamics still(Sphere({0.7, 0.2, 0.1264911064067352}), none);
  const NormalSpin spin(3, 0, 0, 0.7, 0.5);
  DryFrictionMotion sliding =
      DryFrictionMotion::sliding(still, coulomb(0.2), {1, 2}, {0.4, 0.3}, {1, -2}, spin);
  expect_expansion(sliding, 0.2, 0.1, 2, "sliding");
  DryFrictionMotion skidding = DryFrictionMotion::skidding(still, coulomb(0.2), {1, 2}, {1, -2}, spin);
  expect_expansion(skidding, 0.2, 0.1, 2, "skidding");
  DryFrictionMotion rolling = DryFrictionMotion::rolling(still, coulomb(never, 0.001), {1, 2}, {1, -2}, spin);
  expect_expansion(rolling, 0.2, 0.1, 2, "rolling");
  DryFrictionMotion turning =
      DryFrictionMotion::sliding(dynamics, coulomb(0.2), {1, 2}, {0.4, 0.3}, {1, -2}, spin);
  expect_expansion(turning, 0.2, 0.02, polynomials::size, "turning friction");
}

TEST(SpinExpansion, OfAStraightSlideAgainstAResistance) {
  scene::Forces none;
  const Dynamics dynamics(Sphere({0.7, 0.2, 0.1264911064067352}), none);
  auto slide = StraightSlide::from(dynamics, coulomb(0.2, 0.002), {1, 2}, {1, -2}, {-0.2, 0.4},
                                   NormalSpin(3, 0, 0, 0.7, 0.5));
  ASSERT_TRUE(slide);
  expect_expansion(*slide, 0.05, 0.02, 2, "straight slide");
}

TEST(SpinExpansion, OfASlideAlongAnEdge) {
  EdgeSlide slide(dynamics_of({0.05, 0.2}), {-1, 0.5}, {1, 0.25}, {1, 0}, {0, 3}, {0.05, 0.1}, NormalSpin(2));
  const double end = slide.end();
  ASSERT_LT(end, never);
  expect_expansion(slide, 0.5 * end, 0.25 * end, 2, "edge slide");
}

}  // namespace
}  // namespace hybrid_sphere::testing::spin_expansion_test
