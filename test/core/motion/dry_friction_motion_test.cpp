// Against the equations of motion with the friction of the ground, and the laws that hold whatever mu is.

#include "motion/dry_friction_motion.hpp"

#include <gtest/gtest.h>

#include <cfloat>

#include "core/motion/integrated.hpp"

namespace hybrid_sphere::testing::dry_friction_motion_test {
namespace {

constexpr double unit = DBL_EPSILON;

const Vector2d start(1.2, -0.7);
const Vector2d velocity(0.8, 0.5);
const Vector2d slip(3, -2);
const Vector2d belt(0.3, -0.1);

Dynamics dynamics_of(const Vector2d& slope) {
  scene::Forces forces;
  forces.gravity = {slope.x(), slope.y(), -9.8};
  forces.wrench.torque = {0.01, -0.02, 0};
  return {Sphere({0.7, 0.2, 0.1264911064067352}), forces};
}

scene::Material coulomb(double friction, double rolling_resistance = 0) {
  scene::Material material(scene::Law::coulomb);
  material.friction = friction;
  material.rolling_resistance = rolling_resistance;
  material.belt = belt;
  return material;
}

Vector2d conserved(const Dynamics& dynamics, const Vector2d& v, const Vector2d& nu) {
  return (1 - dynamics.kappa) * v + dynamics.kappa * nu;
}

TEST(DryFrictionMotion, SlidesUnderMuNAgainstTheSlip) {
  for (const double friction : {0.05, 0.3, 2.0}) {
    const Dynamics dynamics = dynamics_of({0.4, -0.9});
    const scene::Material material = coulomb(friction);
    const Vector2d nu = velocity - belt - slip;
    DryFrictionMotion motion = DryFrictionMotion::sliding(
        dynamics, material, start, conserved(dynamics, velocity, nu), slip, NormalSpin(3));
    const auto reaction = [&](const Vector2d&, const Vector2d& v, const Vector2d& of_nu) -> Vector2d {
      return -friction * dynamics.normal_force / dynamics.mass * (v - of_nu - belt).normalized();
    };
    const auto derivative = [&](const PlaneState& y, double) {
      return equations_of_motion(dynamics, y, reaction);
    };
    const double last = std::min(2.0, 0.9 * motion.end());
    for (const double time : {0.0, 0.2 * last, last}) {
      const PlaneState y = integrated(plane_state(start, velocity, nu), time, derivative, 400);
      const MotionState now = motion.at(time);
      // Some roundings in each of 400 intervals.
      const double tolerance = 5 * integration_error * (10 + velocity_of(y).norm() + nu_of(y).norm());
      EXPECT_LE((now.center.position - position_of(y)).norm(), tolerance);
      EXPECT_LE((now.center.velocity - velocity_of(y)).norm(), tolerance);
      EXPECT_LE((nu_of(now, dynamics.radius) - nu_of(y)).norm(), tolerance);
      EXPECT_LE((now.contact_velocity - (velocity_of(y) - nu_of(y))).norm(), tolerance);
      EXPECT_LE((now.center.acceleration - velocity_of(derivative(y, 0))).norm(), 10 * tolerance);
      EXPECT_LE(now.center.acceleration.norm(), motion.acceleration_bound(0, last));
      const Vector2d across(-2, 1);
      EXPECT_LE(std::abs(now.center.acceleration.dot(across)),
                motion.acceleration_bound_along(across, 0, last));
    }
  }
}

TEST(DryFrictionMotion, ArrivesAtTheSameVelocityWhateverMuIs) {
  const Dynamics dynamics = dynamics_of({0, 0});
  Dynamics level = dynamics;
  level.spin = {0, 0};
  const Vector2d p_c = conserved(level, velocity, velocity - belt - slip);
  for (const double friction : {1e-3, 0.3, 1e5}) {
    DryFrictionMotion motion =
        DryFrictionMotion::sliding(level, coulomb(friction), start, p_c, slip, NormalSpin(0));
    const double end = motion.end_before(1e9);
    // t = kappa abs(s)/(mu g)
    EXPECT_NEAR(end, level.kappa * slip.norm() / (friction * 9.8), 8 * unit * end);
    const MotionState now = motion.at(end);
    EXPECT_EQ(now.contact_velocity, belt);
    EXPECT_LE((now.center.velocity - (p_c + level.kappa * belt)).norm(), 4 * unit);
    EXPECT_EQ(motion.end_before(0.5 * end), never);
    const Vector2d mean = 0.5 * (velocity + now.center.velocity);
    EXPECT_LE((now.center.position - start - end * mean).norm(), 8 * unit * (start.norm() + end * 4));
  }
}

TEST(DryFrictionMotion, IsAParabolaWhereTheSlipKeepsItsDirection) {
  Dynamics level = dynamics_of({0, 0});
  level.spin = {0, 0};
  DryFrictionMotion straight = DryFrictionMotion::sliding(
      level, coulomb(0.2), start, conserved(level, velocity, velocity - belt - slip), slip, NormalSpin(0));
  const Curve curve = straight.curve();
  ASSERT_EQ(curve.form, CurveForm::parabola);
  const double t = 0.5 * straight.end();
  const Vector2d expected = curve.start + t * curve.velocity + 0.5 * t * t * curve.acceleration;
  EXPECT_LE((straight.at(t).center.position - expected).norm(), 8 * unit * (2 + expected.norm()));
  EXPECT_LE((curve.acceleration + 0.2 * 9.8 * slip.normalized()).norm(), 8 * unit * 2);
  EXPECT_LE(straight.acceleration_bound(0, t), curve.acceleration.norm() * (1 + 1e-10));

  const DryFrictionMotion curved = DryFrictionMotion::sliding(dynamics_of({0.4, -0.9}), coulomb(0.2), start,
                                                              velocity, slip, NormalSpin(0));
  EXPECT_EQ(curved.curve().form, CurveForm::general);
}

TEST(DryFrictionMotion, RollsToRestUnderARollingResistance) {
  Dynamics level = dynamics_of({0, 0});
  level.spin = {0, 0};
  const Vector2d nu(3, 4);
  DryFrictionMotion motion = DryFrictionMotion::rolling(level, coulomb(1, 0.02), start, nu, NormalSpin(0));
  const double decay = 0.02 * (1 - level.kappa) * 9.8;
  const double end = motion.end_before(1e9);
  EXPECT_NEAR(end, 5 / decay, 8 * unit * end);
  const MotionState now = motion.at(end);
  EXPECT_EQ(now.center.velocity, belt);
  EXPECT_EQ(now.contact_velocity, belt);
  EXPECT_EQ(now.angular_velocity, Vector3d(0, 0, 0));
  const Vector2d way = end * belt + 0.5 * end * nu;
  EXPECT_LE((now.center.position - start - way).norm(), 16 * unit * way.norm());
}

TEST(DryFrictionMotion, RollsDownASlopeAgainstTheResistance) {
  const Dynamics dynamics = dynamics_of({0.4, -0.9});
  const Vector2d nu(-1, 2);
  DryFrictionMotion motion = DryFrictionMotion::rolling(dynamics, coulomb(1, 0.05), start, nu, NormalSpin(0));
  const double decay = dynamics.roll_decay(0.05);
  const auto derivative = [&](const PlaneState& y, double) {
    const Vector2d change = dynamics.rolling() - decay * nu_of(y).normalized();
    return plane_state(velocity_of(y), change, change);
  };
  const PlaneState y = integrated(plane_state(start, belt + nu, nu), 3, derivative, 400);
  const MotionState now = motion.at(3);
  const double tolerance = 5 * integration_error * 20;
  EXPECT_LE((now.center.position - position_of(y)).norm(), tolerance);
  EXPECT_LE((now.center.velocity - velocity_of(y)).norm(), tolerance);
  EXPECT_LE((nu_of(now, dynamics.radius) - nu_of(y)).norm(), tolerance);
  EXPECT_EQ(now.contact_velocity, belt);
  EXPECT_FALSE(motion.steady());
}

}  // namespace
}  // namespace hybrid_sphere::testing::dry_friction_motion_test
