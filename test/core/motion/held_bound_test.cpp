// What is known of a motion against dry friction on ground at rest, where forces and friction may nearly
// balance, is never below the true value.

#include "motion/held_bound.hpp"

#include <gtest/gtest.h>

#include <cfloat>

#include "core/motion/random_steps.hpp"
#include "motion/friction_limit.hpp"

namespace hybrid_sphere::testing::held_bound_test {
namespace {

using numeric::EquationForm;
using numeric::Equations;
using numeric::HeldBound;
using numeric::Instant;
using numeric::State;

/// Error of the motion, of which a step has a fiftieth.
constexpr double integrated = 1e-12;
constexpr EquationForm held_forms[] = {EquationForm::resisted_rolling, EquationForm::skidding};

/// A motion against dry friction that is of any size, or what the forces can give, or within any part of
/// that; its direction is any, or that of the forces, or within any angle of it.
struct HeldSegment {
  HeldSegment(EquationForm form, RandomSegments& random) : segment(random.next(form)) {
    segment.ground.turntable_rate = 0;
    segment.ground.belt.setZero();
    const auto little = [&] { return random.one_in(3) ? 0 : std::pow(10, -16 * random.part()); };
    Vector2d v = random.vector(std::pow(10, 4 * random.part() - 3));
    const bool along = !random.one_in(3);
    for (int i = 0; along && i < 8; ++i) v = v.norm() * forcing(v).normalized();
    if (along) v += little() * v.norm() * random.vector(1);
    const bool balanced = !random.one_in(3) && forcing(v).norm() > 0;
    if (balanced) {
      const double part = 1 + (random.one_in(2) ? 1 : -1) * little();
      const bool rolls = form == EquationForm::resisted_rolling;
      const Dynamics& d = segment.dynamics;
      (rolls ? segment.ground.rolling_resistance : segment.ground.friction) =
          part * forcing(v).norm() / (rolls ? d.roll_decay(1) : d.center_decay(1));
    }
    velocity = v;
  }

  Vector2d forcing(const Vector2d& v) const {
    const Equations equations = segment.equations();
    return equations.instant(equations.start(v)).forcing;
  }

  RandomSegment segment;
  Vector2d velocity;
};

/// Calls use(equations, trajectory, random) for the first steps of random motions.
template <class Use>
int for_held_steps(unsigned seed, EquationForm form, const Use& use) {
  RandomSegments random(seed);
  int count = 0;
  for (int n = 0; n < 6 * segments; ++n) {
    const HeldSegment held(form, random);
    const Equations equations = held.segment.equations();
    numeric::Trajectory trajectory(fine);
    trajectory.begin(equations, equations.start(held.velocity));
    try {
      for (int i = 0; i < 8; ++i) trajectory.extend();
    } catch (const std::runtime_error&) {
      continue;  // it dies
    }
    SCOPED_TRACE(n);
    use(equations, trajectory, random);
    if (::testing::Test::HasFailure()) return count;
    ++count;
  }
  return count;
}

/// Of all that the equations add up, whatever cancels.
double size(const Equations& equations, const State& y) {
  const Dynamics& d = equations.dynamics();
  const double speed = equations.instant(y).velocity.norm();
  const double drag = d.translational_drag + d.rotational_drag + d.quadratic_drag * speed;
  return d.free.norm() + d.spin.norm() + drag * speed + equations.decay() +
         d.spring_rate * (numeric::displacement(y).norm() + d.spring_center.norm());
}

struct SharpnessOfHeld {
  Sharpness speed, growth, turning, turning_bend;

  void hold(const Equations& equations, const HeldBound& bound, const State& a, const State& b, double h) {
    const double noise = integrated * size(equations, a);
    speed.hold(equations.instant(a).velocity.norm(), bound.speed);
    const Vector2d e = direction(equations, a);
    const Vector2d forcing = equations.instant(a).forcing;
    growth.hold(std::abs(forcing.dot(e) - equations.decay()), bound.growth, noise);
    turning.hold(std::abs(forcing.dot(turned(e))), bound.turning, noise);
    const Vector2d change = rate(equations, b) - rate(equations, a);
    turning_bend.hold(change.norm(), bound.turning_bend * h, 2 * noise);
  }

 private:
  static Vector2d direction(const Equations& equations, const State& y) {
    return equations.direction(y, equations.instant(y));
  }
  static Vector2d rate(const Equations& equations, const State& y) {
    const Vector2d across = turned(direction(equations, y));
    return equations.instant(y).forcing.dot(across) * across;
  }
};

TEST(HeldBound, IsNeverBelowTheSpeedItsGrowthAndTheTurning) {
  for (const EquationForm form : held_forms) {
    SharpnessOfHeld sharpness;
    const int count = for_held_steps(
        1, form, [&](const Equations& equations, numeric::Trajectory& trajectory, RandomSegments& random) {
          ASSERT_TRUE(equations.holds_velocity());
          for (std::size_t i = 0; i + 1 < trajectory.size(); ++i) {
            const double step = trajectory.node(i).step;
            const double length = step * std::pow(random.part(), 3);
            const State& y = trajectory.node(i).y;
            const double duration = numeric::time_of(trajectory.after(i, length)) - numeric::time_of(y);
            const numeric::SpeedBound coarse(equations, y, duration);
            const HeldBound bound(equations, y, length, duration, coarse);
            for (int k = 0; k < samples; ++k) {
              sharpness.hold(equations, bound, trajectory.after(i, length * k / samples),
                             trajectory.after(i, length * (k + 1) / samples), length / samples);
              if (::testing::Test::HasFatalFailure()) return;
            }
          }
        });
    EXPECT_GT(count, 2 * segments);
    EXPECT_GT(sharpness.speed.largest(), 0.99);
    EXPECT_GT(sharpness.growth.largest(), 0.99);
    EXPECT_GT(sharpness.turning.largest(), 0.99);
    EXPECT_GT(sharpness.turning_bend.largest(), 0.9);
  }
}

// The limit is any, or just what is needed at one place: there the margin itself is 0, and nothing that is
// large hides its bend.
TEST(HeldBound, TheCurvatureOfTheFrictionLimitsMarginIsNeverBelowTheTrueOneOnGroundAtRest) {
  for (const EquationForm form : held_forms) {
    Sharpness sharpness;
    for_held_steps(
        2, form, [&](const Equations& equations, numeric::Trajectory& trajectory, RandomSegments& random) {
          const double needed =
              numeric::FrictionLimit(equations, 0).along_trajectory(trajectory.node(1).y).value;
          const Dynamics& d = equations.dynamics();
          const double of_one = form == EquationForm::skidding ? d.spinning_decay(1) : d.slip_decay(1);
          const numeric::FrictionLimit limit(equations,
                                             random.one_in(2) ? random.size() : std::sqrt(-needed) / of_one);
          for (std::size_t i = 0; i + 1 < trajectory.size(); ++i) {
            const State& y = trajectory.node(i).y;
            const double length = trajectory.node(i).step * std::pow(random.part(), 3);
            const double duration = numeric::time_of(trajectory.after(i, length)) - numeric::time_of(y);
            const auto margin = [&](double x) { return limit.along_trajectory(trajectory.after(i, x)); };
            expect_curvature(margin, length, limit.curvature(y, length, duration), sharpness,
                             size(equations, y));
            if (::testing::Test::HasFatalFailure()) return;
          }
        });
    EXPECT_GT(sharpness.largest(), form == EquationForm::skidding ? 0.5 : 0.9);
  }
}

// What has a direction that rounding does not tell from that of the forces stays on its line; what has
// another one turns towards it.
TEST(HeldBound, KnowsThatWhatGoesAlongTheForcesDoesNotTurn) {
  scene::Forces forces;
  forces.gravity = {1.23, 2.46, -8};
  forces.spring.stiffness = 0.25;
  forces.drag.translational = 0.5;
  scene::Material ground(scene::Law::coulomb);
  ground.rolling_resistance = 0.34375;
  const Equations equations(EquationForm::resisted_rolling, Dynamics(Sphere({1.0, 0.375, 0.0703125}), forces),
                            ground, Vector2d::Zero());
  const auto turning = [&](double off) {
    const Vector2d e = Vector2d(1 - 2 * off, 2 + off).normalized();
    const State y = equations.start(1e-6 * e);
    return HeldBound(equations, y, 1e3, 1e-3, numeric::SpeedBound(equations, y, 1e-3)).turning;
  };
  const double drive = equations.instant(equations.start(Vector2d::Zero())).forcing.norm();
  EXPECT_EQ(turning(0), 0);
  EXPECT_EQ(turning(DBL_EPSILON / 4), 0);
  for (const double off : {1e-14, 1e-8, 1e-2}) {
    EXPECT_GE(turning(off), drive * std::sin(std::atan(off)) * (1 - 4 * DBL_EPSILON / off));
    EXPECT_LE(turning(off), drive * off + 32 * DBL_EPSILON * drive);
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::held_bound_test
