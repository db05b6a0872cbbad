// Against the equations of motion with the reaction of the ground, and the limits where a closed form goes
// wrong first.

#include "motion/linear_motion.hpp"

#include <gtest/gtest.h>

#include <cfloat>

#include "core/motion/integrated.hpp"

namespace hybrid_sphere::testing::linear_motion_test {
namespace {

constexpr double unit = DBL_EPSILON;

Dynamics dynamics_of(const scene::Forces& forces) { return {Sphere({0.7, 0.2, 0.1264911064067352}), forces}; }

scene::Forces no_forces() { return {}; }

scene::Forces pushed() {
  scene::Forces forces;
  forces.gravity = {0.4, -0.3, -9.8};
  forces.wrench = {{0.2, 0.1}, {0.01, -0.02, 0}};
  return forces;
}

scene::Forces with_drag(double translational, double rotational, scene::Forces forces = pushed()) {
  forces.drag.translational = translational;
  forces.drag.rotational = rotational;
  return forces;
}

scene::Forces with_spring(double stiffness, scene::Forces forces = pushed()) {
  forces.spring = {{0.5, -0.2}, stiffness};
  return forces;
}

scene::Material turntable(double rate, scene::Law law = scene::Law::rough) {
  scene::Material material(law);
  material.belt = {0.3, -0.1};
  material.turntable_rate = rate;
  material.turntable_center = {0.4, 0.7};
  return material;
}

const scene::Forces all_forces[] = {no_forces(),
                                    pushed(),
                                    with_drag(0.3, 0),
                                    with_drag(0, 0.002),
                                    with_drag(0.3, 0.002, no_forces()),
                                    with_spring(2),
                                    with_spring(5, with_drag(0.3, 0.002)),
                                    with_spring(0.01, with_drag(9, 0.05))};

const Vector2d start(1.2, -0.7);
const Vector2d velocity(0.8, 0.5);

// Size of what is compared: far more than any value on the way, so that rounding stays below
// integration_error of it.
double size_of(const PlaneState& y) {
  return 10 + position_of(y).norm() + velocity_of(y).norm() + nu_of(y).norm();
}

void expect_agreement(const MotionState& now, const PlaneState& y, double radius) {
  const double tolerance = integration_error * size_of(y);
  EXPECT_LE((now.center.position - position_of(y)).norm(), tolerance);
  EXPECT_LE((now.center.velocity - velocity_of(y)).norm(), tolerance);
  EXPECT_LE((nu_of(now, radius) - nu_of(y)).norm(), tolerance);
  EXPECT_LE((now.contact_velocity - (velocity_of(y) - nu_of(y))).norm(), tolerance);
}

TEST(LinearMotion, RollingObeysTheEquationsWithTheReactionThatPreventsSlip) {
  for (const scene::Forces& forces : all_forces) {
    for (const double rate : {0.0, 1e-9, -2.0}) {
      const Dynamics dynamics = dynamics_of(forces);
      const scene::Material material = turntable(rate);
      const auto reaction = rolling_reaction(dynamics, material);
      LinearMotion motion = LinearMotion::rolling(dynamics, material, start, velocity, NormalSpin(3));
      const auto derivative = [&](const PlaneState& y, double) {
        return equations_of_motion(dynamics, y, reaction);
      };
      const Vector2d nu = velocity - ground_velocity(material, start);
      for (const double time : {0.0, 0.1, 3.0}) {
        const PlaneState y = integrated(plane_state(start, velocity, nu), time, derivative);
        const MotionState now = motion.at(time);
        expect_agreement(now, y, dynamics.radius);
        EXPECT_LE((now.center.acceleration - velocity_of(derivative(y, 0))).norm() / 50,
                  integration_error * size_of(y));  // rates are below 50/s
        EXPECT_LE((motion.reaction(time) - reaction(position_of(y), velocity_of(y), nu_of(y))).norm() / 50,
                  integration_error * size_of(y));
        EXPECT_EQ(now.angular_velocity, motion.angular_velocity(time));
      }
    }
  }
}

TEST(LinearMotion, FreeObeysTheEquationsWithoutReaction) {
  for (const scene::Forces& forces : all_forces) {
    const Dynamics dynamics = dynamics_of(forces);
    const Twist twist{velocity, {4, -3, 2}};
    const Vector2d nu = dynamics.radius * Vector2d(-3, -4);
    LinearMotion motion = LinearMotion::free(dynamics, start, twist, velocity - nu, NormalSpin(2));
    const auto none = [](const auto&...) { return Vector2d(0, 0); };
    const auto derivative = [&](const PlaneState& y, double) {
      return equations_of_motion(dynamics, y, none);
    };
    for (const double time : {0.0, 0.1, 3.0}) {
      const PlaneState y = integrated(plane_state(start, velocity, nu), time, derivative);
      expect_agreement(motion.at(time), y, dynamics.radius);
    }
  }
}

TEST(LinearMotion, KeepsAZeroSlipThatNothingChanges) {
  scene::Forces forces;
  const Dynamics none = dynamics_of(forces);
  const Twist rolling{{0.1, 0.3}, {-1.5, 0.5, 0}};
  LinearMotion motion = LinearMotion::free(none, start, rolling, Vector2d(0, 0), NormalSpin(0));
  EXPECT_EQ(motion.at(1e6).contact_velocity, Vector2d(0, 0));
  EXPECT_EQ(motion.at(1e6).angular_velocity, rolling.angular_velocity);
  EXPECT_EQ(motion.at(1e6).center.velocity, rolling.velocity);
  EXPECT_TRUE(motion.steady());

  forces.wrench.force = {0.35, 0.7};
  const Dynamics pulled = dynamics_of(forces);
  LinearMotion slipping = LinearMotion::free(pulled, start, rolling, Vector2d(0, 0), NormalSpin(0));
  EXPECT_EQ(slipping.at(3).contact_velocity, Vector2d(3 * pulled.slipping()));
}

TEST(LinearMotion, IsAnExactParabolaWithoutDragSpringAndTurntable) {
  const Dynamics dynamics = dynamics_of(pushed());
  LinearMotion motion = LinearMotion::rolling(dynamics, turntable(0), start, velocity, NormalSpin(0));
  const Curve curve = motion.curve();
  ASSERT_EQ(curve.form, CurveForm::parabola);
  EXPECT_EQ(curve.start, start);
  EXPECT_EQ(curve.velocity, velocity);
  EXPECT_EQ(curve.acceleration, dynamics.rolling());
  EXPECT_EQ(motion.at(2).center.velocity, Vector2d(velocity + 2 * dynamics.rolling()));
  EXPECT_EQ(motion.at(2).center.acceleration, dynamics.rolling());
  EXPECT_EQ(motion.at(2).contact_velocity, Vector2d(0.3, -0.1));
}

TEST(LinearMotion, TendsToTheParabolaWhenDragSpringAndTurntableVanish) {
  const Dynamics plain = dynamics_of(pushed());
  LinearMotion parabola = LinearMotion::rolling(plain, turntable(0), start, velocity, NormalSpin(0));
  const Vector2d expected = parabola.at(3).center.position;
  for (const double tiny : {1e-18, 1e-100, 1e-300}) {
    const Dynamics dynamics = dynamics_of(with_spring(tiny, with_drag(tiny, tiny)));
    LinearMotion motion = LinearMotion::rolling(dynamics, turntable(tiny), start, velocity, NormalSpin(0));
    // A handful of roundings of numbers below 10.
    EXPECT_LE((motion.at(3).center.position - expected).norm(), 40 * unit) << tiny;
  }
}

TEST(LinearMotion, CirclesAMillionTimesAndKeepsItsSpeedAndItsCentre) {
  const scene::Material disc = turntable(2);
  const Dynamics dynamics = dynamics_of(no_forces());
  LinearMotion motion = LinearMotion::rolling(dynamics, disc, start, velocity, NormalSpin(0));
  const Curve curve = motion.curve();
  ASSERT_EQ(curve.form, CurveForm::arc);
  EXPECT_DOUBLE_EQ(curve.rate, 2 * dynamics.kappa);
  EXPECT_EQ(curve.orbit_center + curve.arm, start);
  const double radius = curve.arm.norm();
  EXPECT_DOUBLE_EQ(radius * std::abs(curve.rate), velocity.norm());
  for (const double rounds : {1e-12, 0.3, 1e3, 999999.7}) {
    const MotionState now = motion.at(rounds * motion.period());
    EXPECT_NEAR(now.center.velocity.norm(), velocity.norm(), 8 * unit);
    EXPECT_NEAR((now.center.position - curve.orbit_center).norm(), radius,
                8 * unit * (radius + start.norm()));
  }
}

TEST(LinearMotion, TurnsByTheSmallestAngleWithoutLoss) {
  // Omega t = 1e-12: r - r_0 = v t, and v has turned by Omega t.
  const Dynamics dynamics = dynamics_of(no_forces());
  const scene::Material disc = turntable(1e-12 / dynamics.kappa);
  LinearMotion motion = LinearMotion::rolling(dynamics, disc, Vector2d(0, 0), velocity, NormalSpin(0));
  const MotionState now = motion.at(1);
  EXPECT_LE((now.center.position - velocity - 0.5e-12 * turned(velocity)).norm(), 2 * unit);
  EXPECT_LE((now.center.velocity - velocity - 1e-12 * turned(velocity)).norm(), 2 * unit);
}

TEST(LinearMotion, LosesNothingFarFromTheOrigin) {
  const Vector2d far(1e8, -1e8);  // 1e8 + start is exact in units of 2^-26
  const Vector2d near(0.25, -0.5);
  const Dynamics dynamics = dynamics_of(no_forces());
  scene::Material here = turntable(2);
  here.turntable_center = {0.75, 0.5};
  scene::Material there = here;
  there.turntable_center += far;
  LinearMotion at_origin = LinearMotion::rolling(dynamics, here, near, velocity, NormalSpin(0));
  LinearMotion far_away = LinearMotion::rolling(dynamics, there, near + far, velocity, NormalSpin(0));
  const MotionState a = at_origin.at(7);
  const MotionState b = far_away.at(7);
  EXPECT_EQ(a.center.velocity, b.center.velocity);
  EXPECT_EQ(a.contact_velocity, b.contact_velocity);
  EXPECT_EQ(b.center.position, Vector2d(near + far + (a.center.position - near)));
}

TEST(LinearMotion, BoundsItsAcceleration) {
  for (const scene::Forces& forces : all_forces) {
    for (const double rate : {0.0, 1e-9, -2.0}) {
      LinearMotion motion =
          LinearMotion::rolling(dynamics_of(forces), turntable(rate), start, velocity, NormalSpin(0));
      for (const double from : {0.0, 0.37, 4.0}) {
        for (const double span : {1e-3, 0.2, 5.0}) {
          const double bound = motion.acceleration_bound(from, from + span);
          const Vector2d direction(3, -1);
          const double along = motion.acceleration_bound_along(direction, from, from + span);
          double largest = 0;
          for (int i = 0; i <= 100; ++i) {
            const Vector2d acceleration = motion.center(from + span * i / 100).acceleration;
            largest = std::max(largest, acceleration.norm());
            // The values themselves are rounded by some ulp of the acceleration at the start.
            EXPECT_LE(acceleration.norm(), bound + 100 * unit) << from << " " << span;
            EXPECT_LE(std::abs(acceleration.dot(direction)), along + 100 * unit);
          }
          // Over a short time the bound is worth something.
          if (span == 1e-3) {
            EXPECT_LE(bound, 1.1 * largest + 1e-3);
          }
        }
      }
    }
  }
}

TEST(LinearMotion, LosesItsGripWhereTheReactionReachesTheLimit) {
  int lost = 0;
  for (const scene::Forces& forces : all_forces) {
    for (const double share : {1.01, 1.3, 2.0}) {
      const Dynamics dynamics = dynamics_of(forces);
      scene::Material material = turntable(3, scene::Law::coulomb);
      const double at_start =
          LinearMotion::rolling(dynamics, material, start, velocity, NormalSpin(0)).reaction(0).norm();
      const double limit = share * at_start;
      material.friction = limit * dynamics.mass / dynamics.normal_force;
      LinearMotion motion = LinearMotion::rolling(dynamics, material, start, velocity, NormalSpin(0));
      const double end = motion.end_before(8);
      EXPECT_EQ(motion.end_before(0.5 * std::min(end, 8.0)), never);
      for (double t = 0; t < std::min(end, 8.0); t += 1e-3) {
        ASSERT_LE(motion.reaction(t).norm(), limit * (1 + 20 * unit)) << t;
      }
      if (end == never) continue;
      ++lost;
      // Transversal: the reaction changes by at most some limit per second.
      EXPECT_NEAR(motion.reaction(end).norm(), limit, 100 * unit * limit);
      EXPECT_GT(motion.reaction(end + 1e-6).norm(), limit);
    }
  }
  EXPECT_GE(lost, 4);
}

TEST(LinearMotion, KeepsItsGripWhereTheReactionIsConstantOrNotLimited) {
  scene::Material material = turntable(3, scene::Law::coulomb);
  const Dynamics dynamics = dynamics_of(no_forces());
  // abs(lambda) = m kappa abs(W) abs(v) all around the circle, here within an ulp of the limit.
  material.friction = dynamics.kappa * 3 * velocity.norm() * dynamics.mass / dynamics.normal_force;
  EXPECT_EQ(LinearMotion::rolling(dynamics, material, start, velocity, NormalSpin(0)).end_before(1e6), never);
  material.law = scene::Law::rough;
  EXPECT_EQ(
      LinearMotion::rolling(dynamics_of(pushed()), material, start, velocity, NormalSpin(0)).end_before(1e6),
      never);
}

// By drag of the spin on a turntable. The bound takes both modes for growing and adds their sizes.
TEST(LinearMotion, ThatGrowsEndsBeforeItsSpeedIsBeyondNumbers) {
  for (const double force : {0.0, 0.75}) {
    for (const double drag : {1e-1, 1e-4, 1e-7, 1e-10}) {
      scene::Forces forces;
      forces.wrench.force.x() = force;
      forces.drag.rotational = drag;
      LinearMotion motion =
          LinearMotion::rolling(dynamics_of(forces), turntable(5), start, velocity, NormalSpin(3));
      const double speed = motion.at(motion.last_time()).center.velocity.norm();
      EXPECT_LE(speed, 1e100) << force << ", " << drag;
      EXPECT_GE(speed, 1e97) << force << ", " << drag;
    }
  }
}

TEST(LinearMotion, KnowsWhereItsSpinIsConstantOrPeriodic) {
  const Dynamics free = dynamics_of(no_forces());
  const Dynamics forced = dynamics_of(pushed());
  const auto rolling = [](const Dynamics& dynamics, double rate, const NormalSpin& spin) {
    return LinearMotion::rolling(dynamics, turntable(rate), start, velocity, spin);
  };
  EXPECT_TRUE(rolling(free, 0, NormalSpin(1)).steady());
  EXPECT_FALSE(rolling(free, 0, NormalSpin(1, 2, 0, 0, 0)).steady());
  EXPECT_FALSE(rolling(free, 2, NormalSpin(1)).steady());
  EXPECT_FALSE(rolling(forced, 0, NormalSpin(1)).steady());
  EXPECT_EQ(rolling(forced, 2, NormalSpin(1)).period(), never);
  EXPECT_EQ(rolling(free, 2, NormalSpin(1, 2, 0, 0, 0)).period(), never);
  LinearMotion periodic = rolling(free, 2, NormalSpin(1));
  EXPECT_LE((periodic.angular_velocity(periodic.period()) - periodic.angular_velocity(0)).norm(),
            100 * unit * periodic.angular_velocity(0).norm());
}

}  // namespace
}  // namespace hybrid_sphere::testing::linear_motion_test
