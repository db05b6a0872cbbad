// What every motion with a closed form promises (Motion), on random ones: velocities and accelerations are
// the derivatives of places, bounds hold, and the curve is the path.

#include "motion/motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "motion/dry_friction_motion.hpp"
#include "motion/edge_slide.hpp"
#include "motion/linear_motion.hpp"
#include "motion/straight_slide.hpp"

namespace hybrid_sphere::testing::motion_test {
namespace {

/// Numbers of the order of 1.
class Draws {
 public:
  double number() { return std::uniform_real_distribution<double>(-2, 2)(engine_); }
  double size() { return std::uniform_real_distribution<double>(0.25, 2)(engine_); }
  Vector2d vector() { return {number(), number()}; }
  /// @param everything  drag and a spring, too
  Dynamics dynamics(bool everything) {
    const double radius = size();
    const double mass = size();
    scene::Forces forces;
    forces.gravity = {number(), number(), -8};
    forces.wrench.force = vector();
    forces.wrench.torque = {number(), number(), 0};
    if (everything) {
      forces.drag.translational = mass * size();
      forces.drag.rotational = mass * 0.36 * radius * radius * size();
      forces.spring = {vector(), mass * size()};
    }
    return {Sphere({mass, radius, radius * 0.6}), forces};
  }
  scene::Material coulomb() {
    scene::Material material(scene::Law::coulomb);
    material.friction = 0.2 * size();
    material.rolling_resistance = 0.1 * size();
    material.belt = vector();
    return material;
  }

 private:
  std::mt19937 engine_{20051};
};

// Boole's rule over 1/64 of the time is off by h^7/2e6 of a sixth derivative: of the order of 1e-13 here.
constexpr double quadrature = 1e-11;

void expect_derivatives(Motion& motion, double from, double until) {
  constexpr double weights[] = {7.0 / 90, 32.0 / 90, 12.0 / 90, 32.0 / 90, 7.0 / 90};
  const double h = until - from;
  Vector2d way = motion.center(from).position - motion.center(until).position;
  Vector2d change = motion.center(from).velocity - motion.center(until).velocity;
  for (int i = 0; i < 5; ++i) {
    const PointState now = motion.center(from + 0.25 * i * h);
    way += h * weights[i] * now.velocity;
    change += h * weights[i] * now.acceleration;
  }
  EXPECT_LE(way.norm(), quadrature);
  EXPECT_LE(change.norm(), quadrature);
}

void expect_bounds(Motion& motion, double from, double until) {
  constexpr double rounding = 1e-13;
  const Vector2d direction(3, -1);
  const double bound = motion.acceleration_bound(from, until);
  const double along = motion.acceleration_bound_along(direction, from, until);
  for (int i = 0; i <= 8; ++i) {
    const Vector2d acceleration = motion.center(from + (until - from) * i / 8).acceleration;
    EXPECT_LE(acceleration.norm(), bound + rounding);
    EXPECT_LE(std::abs(acceleration.dot(direction)), along + rounding);
  }
}

Vector2d on_curve(const Curve& curve, double tau) {
  if (curve.form == CurveForm::parabola)
    return curve.start + tau * (curve.velocity + 0.5 * tau * curve.acceleration);
  const double angle = curve.rate * tau;
  return curve.orbit_center + std::cos(angle) * curve.arm + std::sin(angle) * turned(curve.arm);
}

void expect_contract(Motion& motion, double until) {
  constexpr int pieces = 64;
  constexpr double rounding = 1e-12;
  const Curve curve = motion.curve();
  const Vector2d start = motion.center(0).position;
  for (int i = 0; i < pieces; ++i) {
    const double tau = until * i / pieces;
    const double next = until * (i + 1) / pieces;
    expect_derivatives(motion, tau, next);
    expect_bounds(motion, tau, next);
    const PointState now = motion.center(next);
    EXPECT_LE((motion.at(next).center.position - now.position).norm(), rounding);
    EXPECT_LE((motion.at(next).center.velocity - now.velocity).norm(), rounding);
    EXPECT_LE((motion.at(next).angular_velocity - motion.angular_velocity(next)).norm(), rounding);
    if (curve.form != CurveForm::general) {
      EXPECT_LE((on_curve(curve, next) - now.position).norm(), rounding);
    }
    if (!curve.line.isZero(0)) {
      EXPECT_LE(std::abs(turned(curve.line.normalized()).dot(now.position - start)), rounding);
    }
  }
  EXPECT_EQ(motion.steps(0, until), 0U);
}

/// The end, or three seconds, and nothing before.
double time_of(Motion& motion) {
  const double end = motion.end_before(3);
  EXPECT_EQ(motion.end_before(0.5 * std::min(end, 3.0)), never);
  // At the end itself the acceleration jumps; next to it dry friction may turn round.
  return 0.75 * std::min(end, 3.0);
}

TEST(Motion, OfLinearForcesKeepsItsPromises) {
  Draws draws;
  for (int n = 0; n < 50; ++n) {
    SCOPED_TRACE(n);
    const Dynamics dynamics = draws.dynamics(n % 2 == 0);
    scene::Material ground(scene::Law::rough);
    if (n % 3 != 0) ground.turntable_rate = draws.number();
    ground.turntable_center = draws.vector();
    LinearMotion rolling =
        LinearMotion::rolling(dynamics, ground, draws.vector(), draws.vector(), NormalSpin(1));
    expect_contract(rolling, 2);
    const Twist twist{draws.vector(), {draws.number(), draws.number(), 1}};
    const Vector2d sigma =
        twist.velocity + dynamics.radius * Vector2d(-twist.angular_velocity.y(), twist.angular_velocity.x());
    LinearMotion free = LinearMotion::free(dynamics, draws.vector(), twist, sigma, NormalSpin(1));
    expect_contract(free, 2);
  }
}

TEST(Motion, OnATurntableWithoutForcesIsAnArc) {
  Draws draws;
  for (int n = 0; n < 20; ++n) {
    SCOPED_TRACE(n);
    scene::Material ground(scene::Law::rough);
    ground.turntable_rate = draws.number();
    LinearMotion motion = LinearMotion::rolling({Sphere({1, 0.5, 0.3}), scene::Forces()}, ground,
                                                draws.vector(), draws.vector(), NormalSpin(1));
    ASSERT_EQ(motion.curve().form, CurveForm::arc);
    expect_contract(motion, 5);
  }
}

TEST(Motion, UnderDryFrictionKeepsItsPromises) {
  Draws draws;
  for (int n = 0; n < 50; ++n) {
    SCOPED_TRACE(n);
    const Dynamics dynamics = draws.dynamics(false);
    const scene::Material ground = draws.coulomb();
    DryFrictionMotion motions[] = {
        DryFrictionMotion::sliding(dynamics, ground, draws.vector(), draws.vector(), draws.vector(),
                                   NormalSpin(1)),
        DryFrictionMotion::skidding(dynamics, ground, draws.vector(), draws.vector(), NormalSpin(1)),
        DryFrictionMotion::rolling(dynamics, ground, draws.vector(), draws.vector(), NormalSpin(1))};
    for (DryFrictionMotion& motion : motions) {
      const double until = time_of(motion);
      // Where the friction turns within less than that, the quadrature does not see how.
      if (motion.corner().width > 0.5) expect_contract(motion, until);
      expect_bounds(motion, 0, until);
    }
  }
}

TEST(Motion, OfAStraightSlideKeepsItsPromises) {
  Draws draws;
  for (int n = 0; n < 50; ++n) {
    SCOPED_TRACE(n);
    const Vector2d along = draws.vector();
    scene::Forces forces;
    forces.gravity = {0, 0, -8};
    forces.wrench.force = 0.5 * draws.number() * along;
    const Dynamics dynamics(Sphere({draws.size(), 0.5, 0.25}), forces);
    const auto slide = StraightSlide::from(dynamics, draws.coulomb(), draws.vector(), along,
                                           draws.number() * along, NormalSpin(1));
    ASSERT_TRUE(slide);
    StraightSlide motion = *slide;
    expect_contract(motion, time_of(motion));
  }
}

TEST(Motion, AlongAnEdgeKeepsItsPromises) {
  Draws draws;
  for (int n = 0; n < 50; ++n) {
    SCOPED_TRACE(n);
    const Vector2d normal = draws.vector().normalized();
    const Vector2d across = draws.size() * normal;
    EdgeSlide motion(draws.dynamics(false), turned(normal) - across, draws.number() * turned(normal) + across,
                     normal, draws.vector(), draws.number() * turned(normal), NormalSpin(1));
    expect_contract(motion, time_of(motion));
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::motion_test
