// The response of the ground against a minimisation by brute force, and against the closed form that follows.

#include "sphere/contact_mode.hpp"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <random>

#include "core/motion/integrated.hpp"
#include "motion/numeric_motion.hpp"
#include "motion/straight_slide.hpp"

namespace hybrid_sphere::testing::contact_mode_test {
namespace {

class Random {
 public:
  double operator()(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }
  Vector2d vector(double size) { return {(*this)(-size, size), (*this)(-size, size)}; }

 private:
  std::mt19937 generator_{1};
};

ContactForces random_forces(Random& random) {
  ContactForces forces;
  forces.drive = random.vector(4);
  forces.spin = random.vector(4);
  forces.kappa = random(0.05, 0.4);
  forces.friction = random(0, 4);
  forces.resistance = random(0.01, 4);
  forces.drive_size = forces.drive.norm();
  return forces;
}

Vector2d shortened(const Vector2d& w, double limit) {
  return w.norm() <= limit ? w : Vector2d(limit / w.norm() * w);
}

/// The reaction and the couple of least acceleration, by taking the best one beside the other in turn. Each
/// round divides what is missing by 1/(1 - kappa) at least.
ContactResponse by_brute_force(const ContactForces& forces, const Vector2d& slip, const Vector2d& nu) {
  const double kappa = forces.kappa;
  const Vector2d share = kappa / (1 - kappa) * forces.spin;
  ContactResponse out;
  if (!slip.isZero(0)) out.reaction = -forces.friction * slip.normalized();
  if (!nu.isZero(0)) out.couple = forces.resistance * nu.normalized();
  for (int i = 0; i < 2000; ++i) {
    if (nu.isZero(0)) out.couple = shortened(share - out.reaction, forces.resistance);
    if (slip.isZero(0)) {
      out.reaction = shortened((1 - kappa) * (share - out.couple) - kappa * forces.drive, forces.friction);
    }
  }
  out.roll_rate = forces.spin - (1 - kappa) / kappa * (out.reaction + out.couple);
  out.slip_rate = forces.drive + out.reaction - out.roll_rate;
  const bool slips = !slip.isZero(0) || out.slip_rate.norm() > 1e-9;
  const bool turns = !nu.isZero(0) || out.roll_rate.norm() > 1e-9;
  out.mode = slips ? (turns ? ContactMode::sliding : ContactMode::skidding)
                   : (turns ? ContactMode::rolling : ContactMode::sticking);
  return out;
}

TEST(ContactMode, TheResponseOfTheGroundIsThatOfLeastAcceleration) {
  Random random;
  std::map<ContactMode, int> seen;
  for (int i = 0; i < 4000; ++i) {
    const ContactForces forces = random_forces(random);
    const Vector2d slip = i % 2 == 0 ? Vector2d(0, 0) : random.vector(1);
    const Vector2d nu = i % 4 < 2 ? Vector2d(0, 0) : random.vector(1);
    const ContactResponse expected = by_brute_force(forces, slip, nu);
    const ContactResponse response = contact_response(forces, slip, nu);
    ++seen[response.mode];
    ASSERT_EQ(response.mode, expected.mode) << "case " << i;
    // 2000 rounds, each of some roundings of rates up to (1 - kappa)/kappa (4 + 4 + 4).
    const double tolerance = 1e-11;
    EXPECT_LE((response.slip_rate - expected.slip_rate).norm(), tolerance) << "case " << i;
    EXPECT_LE((response.roll_rate - expected.roll_rate).norm(), tolerance) << "case " << i;
  }
  EXPECT_EQ(seen.size(), 4U);
  for (const auto& [mode, count] : seen) EXPECT_GT(count, 50) << "mode " << static_cast<int>(mode);
}

// Every other reaction and couple that the velocities allow accelerates the sphere more.
TEST(ContactMode, TheResponseOfTheGroundHasNoNeighbourOfLessAcceleration) {
  Random random;
  for (int i = 0; i < 500; ++i) {
    const ContactForces forces = random_forces(random);
    const ContactResponse response = contact_response(forces, {0, 0}, {0, 0});
    const double weight = forces.kappa / (1 - forces.kappa);
    const auto norm = [&](const Vector2d& reaction, const Vector2d& couple) {
      const Vector2d roll_rate = forces.spin - (reaction + couple) / weight;
      return (forces.drive + reaction).squaredNorm() + weight * roll_rate.squaredNorm();
    };
    const double least = norm(response.reaction, response.couple);
    for (int k = 0; k < 50; ++k) {
      const Vector2d reaction = shortened(response.reaction + random.vector(0.01), forces.friction);
      const Vector2d couple = shortened(response.couple + random.vector(0.01), forces.resistance);
      EXPECT_GE(norm(reaction, couple), least * (1 - 1e-14)) << "case " << i;
    }
  }
}

TEST(ContactMode, TheResponseOfTheGroundIsTheSameInAllUnits) {
  Random random;
  for (int i = 0; i < 500; ++i) {
    const ContactForces forces = random_forces(random);
    ContactForces scaled = forces;
    const double unit = 0x1p-70;
    scaled.drive *= unit;
    scaled.spin *= unit;
    scaled.friction *= unit;
    scaled.resistance *= unit;
    scaled.drive_size *= unit;
    const ContactResponse response = contact_response(forces, {0, 0}, {0, 0});
    const ContactResponse other = contact_response(scaled, {0, 0}, {0, 0});
    ASSERT_EQ(other.mode, response.mode);
    EXPECT_EQ(other.slip_rate, unit * response.slip_rate);
    EXPECT_EQ(other.roll_rate, unit * response.roll_rate);
  }
}

TEST(ContactMode, TheResponseOfTheGroundHoldsWhatRoundingCannotTellFromHeld) {
  ContactForces forces;
  forces.kappa = 0.2;
  forces.friction = 3 * 0.1;
  forces.resistance = 0.1;
  forces.drive = {0.1 * (1 + DBL_EPSILON), 0};
  forces.drive_size = 0.1;
  EXPECT_EQ(contact_response(forces, {0, 0}, {0, 0}).mode, ContactMode::sticking);
  forces.drive *= 1 + 1e-13;
  EXPECT_EQ(contact_response(forces, {0, 0}, {0, 0}).mode, ContactMode::rolling);
}

scene::Material felt(double friction, double resistance) {
  scene::Material material(scene::Law::coulomb);
  material.friction = friction;
  material.rolling_resistance = resistance;
  material.belt = {0.25, -0.125};
  return material;
}

Dynamics dynamics_of(const Vector2d& force, const Vector2d& torque) {
  scene::Forces forces;
  forces.gravity = {0, 0, -8};
  forces.wrench.force = force;
  forces.wrench.torque = {torque.x(), torque.y(), 0};
  return {Sphere({2, 0.5, 0.25}), forces};
}

// All along (3, 4): the slip and nu, the force, and the torque that turns the sphere along it.
TEST(StraightSlide, IsTheMotionThatIsIntegrated) {
  const Vector2d along(0.6, 0.8);
  for (const double force : {0.0, 1.0}) {
    const Dynamics dynamics = dynamics_of(force * along, force * Vector2d(-0.08, 0.06));
    for (const double resistance : {0.05, 0.3, 0.9}) {
      for (const double nu : {-2.0, 0.5, 3.0}) {
        const scene::Material material = felt(0.25, resistance);
        const auto straight =
            StraightSlide::from(dynamics, material, {1, 2}, along, nu * along, NormalSpin(1));
        ASSERT_TRUE(straight);
        StraightSlide motion = *straight;
        NumericMotion numeric(dynamics, {scene::Solver::Method::automatic, 1e-12});
        numeric.begin_resisted_sliding(material, {1, 2}, material.belt + (1 + nu) * along, along, nu * along,
                                       NormalSpin(1));
        const double end = motion.end_before(100);
        ASSERT_LT(end, never);
        // The accuracy, relative to the scale of motion: speeds up to 4 m/s.
        EXPECT_NEAR(numeric.end_before(100), end, 1e-11 * end);
        EXPECT_EQ(numeric.end_reason(), motion.end_reason());
        const Curve curve = motion.curve();
        ASSERT_EQ(curve.form, CurveForm::parabola);
        EXPECT_TRUE(parallel(curve.line, along, curve.line.norm()));
        for (const double tau : {0.0, 0.3 * end, 0.9 * end, end}) {
          const Vector2d on_curve = curve.start + tau * (curve.velocity + 0.5 * tau * curve.acceleration);
          EXPECT_LE((motion.center(tau).position - on_curve).norm(), 1e-14);
          const MotionState a = motion.at(tau);
          const MotionState b = numeric.at(tau);
          EXPECT_LE((a.center.position - b.center.position).norm(), 1e-11);
          EXPECT_LE((a.center.velocity - b.center.velocity).norm(), 1e-11);
          EXPECT_LE((a.contact_velocity - b.contact_velocity).norm(), 1e-11);
          EXPECT_LE((a.angular_velocity - b.angular_velocity).norm(), 1e-10);
          // At the end it jumps: the closed form gives its limit from before, the integrated motion that from
          // after it, where the ground holds what is used up.
          if (tau < end) {
            EXPECT_LE((a.center.acceleration - b.center.acceleration).norm(), 1e-10);
          }
        }
      }
    }
  }
}

TEST(StraightSlide, IsNoneWhereTheSlipTurns) {
  const Dynamics dynamics = dynamics_of({0, 0}, {0, 0});
  const scene::Material material = felt(0.25, 0.1);
  EXPECT_FALSE(StraightSlide::from(dynamics, material, {0, 0}, {1, 0}, {1, 1}, NormalSpin(0)));
  EXPECT_TRUE(StraightSlide::from(dynamics, material, {0, 0}, {1, 0}, {-1, 0}, NormalSpin(0)));
}

TEST(StraightSlide, MayHaveASlipInAnyDirectionWithoutFriction) {
  const Dynamics dynamics = dynamics_of({0, 0}, {0, 0});
  EXPECT_TRUE(StraightSlide::from(dynamics, felt(0, 0.1), {0, 0}, {0, 1}, {-1, 0}, NormalSpin(0)));
}

// s' = f - W J v + ... with the ground's force and couple, integrated step by step.
TEST(NumericMotion, SlidesAgainstAResistanceUnderEveryForce) {
  scene::Forces forces;
  forces.gravity = {1, -0.5, -8};
  forces.wrench.torque = {0.05, -0.1, 0};
  forces.drag = {0.25, 0.02, 0.125};
  forces.spring = {{1, 0}, 3};
  const Dynamics dynamics(Sphere({2, 0.5, 0.25}), forces);
  scene::Material material = felt(0.25, 0.1);
  material.belt.setZero();
  material.turntable_rate = 0.75;
  const Vector2d start(0.5, -0.25), slip(2, 1), nu(-1, 2);
  const Vector2d velocity = slip + nu + ground_velocity(material, start);
  NumericMotion motion(dynamics, {scene::Solver::Method::automatic, 1e-12});
  motion.begin_resisted_sliding(material, start, velocity, slip, nu, NormalSpin(0));
  const double end = motion.end_before(100);
  const auto derivative = [&](const PlaneState& y, double) {
    const Vector2d r = position_of(y), v = velocity_of(y), of_nu = nu_of(y);
    const Vector2d s = v - of_nu - ground_velocity(material, r);
    const double limit = dynamics.normal_force / dynamics.mass;
    const Vector2d reaction = -material.friction * limit * s.normalized();
    const Vector2d couple = material.rolling_resistance * limit * of_nu.normalized();
    const Vector2d turning =
        dynamics.spin_acceleration(of_nu) - (1 - dynamics.kappa) / dynamics.kappa * (reaction + couple);
    return plane_state(v, dynamics.acceleration(r, v) + reaction, turning);
  };
  for (const double tau : {0.25 * end, 0.75 * end}) {
    const PlaneState y = integrated(plane_state(start, velocity, nu), tau, derivative, 400);
    const MotionState now = motion.at(tau);
    EXPECT_LE((now.center.position - position_of(y)).norm(), 1e-11);
    EXPECT_LE((now.center.velocity - velocity_of(y)).norm(), 1e-11);
    EXPECT_LE((now.contact_velocity - (velocity_of(y) - nu_of(y))).norm(), 1e-11);
    EXPECT_LE((now.center.acceleration - velocity_of(derivative(y, 0))).norm(), 1e-9);
    EXPECT_LE(now.center.acceleration.norm(), motion.acceleration_bound(0, tau));
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::contact_mode_test
