#include "motion/numeric_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <vector>

namespace hybrid_sphere::testing::numeric_motion_test {
namespace {

const scene::SphereBody ball{1.0, 0.1, 0.0632455532033676};
const Sphere sphere(ball);

scene::Material coulomb(double friction, double turntable_rate = 0) {
  scene::Material ground(scene::Law::coulomb);
  ground.friction = friction;
  ground.turntable_rate = turntable_rate;
  return ground;
}

void slide(NumericMotion& motion, const scene::Material& ground, const Vector2d& position,
           const Twist& twist) {
  motion.begin_sliding(ground, position, sphere.conserved_velocity(twist),
                       sphere.contact_velocity(twist) - ground_velocity(ground, position),
                       NormalSpin(twist.angular_velocity.z()));
}

// Largest deviation of a free motion with quadratic drag from v = v_0/(1 + c v_0 t), relative to v_0 and to
// the way.
double error_of_quadratic_drag(double accuracy) {
  constexpr double c = 0.5;
  constexpr double v_0 = 3;
  scene::Forces forces;
  forces.drag.quadratic = c;
  NumericMotion motion(Dynamics(sphere, forces), {scene::Solver::Method::automatic, accuracy});
  const Vector2d direction(0.6, -0.8);
  motion.begin_free({1, 2}, {v_0 * direction, {1, 2, 3}}, NormalSpin(3));
  double error = 0;
  for (const double t : {0.01, 0.3, 1.0, 4.0, 20.0, 100.0}) {
    const PointState center = motion.center(t);
    const double growth = 1 + c * v_0 * t;
    const double way = std::log1p(c * v_0 * t) / c;
    error = std::max(error, (center.velocity - v_0 / growth * direction).norm() / v_0);
    error = std::max(error, (center.position - Vector2d(1, 2) - way * direction).norm() / way);
  }
  return error;
}

TEST(NumericMotion, KeepsTheAccuracyThatIsAskedForUnderQuadraticDrag) {
  for (const double accuracy : {1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14}) {
    EXPECT_LE(error_of_quadratic_drag(accuracy), accuracy);
  }
  // The error falls with what is asked for, until rounding is reached.
  EXPECT_GT(error_of_quadratic_drag(1e-4), 100 * error_of_quadratic_drag(1e-9));
}

struct Expected {
  double time;
  Vector2d position, velocity;
  double position_tolerance, velocity_tolerance;
};

// Scene o19_coulomb_turntable of the reference collection: values of 30 digits, with the deviation that one
// ulp of the data makes as tolerance.
TEST(NumericMotion, SlidesOnATurntableToTheLastFigure) {
  const std::vector<Expected> expected{
      {0.05,
       {0.61001728041492364493312348246, -0.0125475896863414118707442547606},
       {0.20102053131280065969540906126, -0.201906968110906940398533880811},
       1.52e-15,
       1.12e-15},
      {0.1,
       {0.620131114742029084053447898728, -0.0201912590858206927840232518554},
       {0.203777158507331958766068629739, -0.103846623263773345293366649321},
       1.56e-15,
       1.71e-15},
      {0.2679634798040745342402187077,
       {0.65525721165037001089970292584, -0.00997750399437141846753134450011},
       {0.207126788567408168182520445803, 0.225183722607407233040346369693},
       2.05e-15,
       3.66e-15}};
  NumericMotion motion(Dynamics(sphere, {}), {scene::Solver::Method::automatic, 1e-14});
  slide(motion, coulomb(0.2, 2.5), {0.6, 0}, {{0.2, -0.3}, {1, 2, 1}});
  const double end = motion.end_before(3);
  EXPECT_EQ(motion.end_reason(), MotionEnd::slip_used_up);
  // 2.6e-16 s by one ulp of the data; a few roundings of the sum of the steps.
  EXPECT_NEAR(end, expected.back().time, 1e-15);
  for (const Expected& there : expected) {
    const MotionState now = motion.at(std::min(there.time, end));
    EXPECT_LE((now.center.position - there.position).lpNorm<Eigen::Infinity>(), there.position_tolerance);
    EXPECT_LE((now.center.velocity - there.velocity).lpNorm<Eigen::Infinity>(), there.velocity_tolerance);
  }
}

TEST(NumericMotion, EndsASlideWithoutSlip) {
  NumericMotion motion(Dynamics(sphere, {}), {scene::Solver::Method::automatic, 1e-9});
  const scene::Material ground = coulomb(0.2, 2.5);
  slide(motion, ground, {0.6, 0}, {{0.2, -0.3}, {1, 2, 1}});
  const MotionState last = motion.at(motion.end_before(3));
  // u of the displaced start and u of the position: a few roundings of either.
  EXPECT_LE((last.contact_velocity - ground_velocity(ground, last.center.position)).norm(), 1e-15);
}

// Level ground at rest: s = s_0 - A e t, v = v_0 - kappa A e t (docs/theory.md 5).
TEST(NumericMotion, SlidesOnLevelGroundAlongAParabola) {
  const Dynamics dynamics(sphere, {});
  const scene::Material ground = coulomb(0.3);
  const Twist twist{{1, 0.5}, {2, -3, 0}};
  NumericMotion motion(dynamics, {scene::Solver::Method::automatic, 1e-13});
  slide(motion, ground, {0, 0}, twist);
  const Vector2d slip = sphere.contact_velocity(twist);
  const double decay = dynamics.slip_decay(0.3);
  const double end = slip.norm() / decay;
  EXPECT_NEAR(motion.end_before(10), end, 1e-13 * end);
  EXPECT_EQ(motion.end_before(0.5 * end), never);
  for (const double t : {0.1 * end, 0.5 * end, 0.999 * end}) {
    const Vector2d deceleration = dynamics.kappa * decay * slip.normalized();
    const PointState center = motion.center(t);
    EXPECT_LE((center.velocity - (twist.velocity - deceleration * t)).norm(), 1e-13);
    EXPECT_LE((center.position - t * (twist.velocity - 0.5 * t * deceleration)).norm(), 1e-13);
    EXPECT_LE((center.acceleration + deceleration).norm(), 1e-12 * deceleration.norm());
  }
}

// Where start, forces and slip lie on an oblique line, so does all that follows, within a few roundings: the
// edge of a ground may be on that line.
TEST(NumericMotion, StaysOnItsLineByEveryMethod) {
  using Method = scene::Solver::Method;
  const Vector2d line = Vector2d(-2, 3).normalized();
  scene::Forces forces;
  forces.gravity.head<2>() = 600 * line;
  forces.spring.stiffness = 0.75;
  scene::Material ground = coulomb(0.3);
  ground.rolling_resistance = 0.02;
  for (const Method method : {Method::automatic, Method::cvode_adams, Method::cvode_bdf, Method::dopri5}) {
    NumericMotion motion(Dynamics(sphere, forces), {method, 1e-9});
    const Vector2d nu = -0.4 * line;
    motion.begin_resisted_sliding(ground, {0, 0}, {0, 0}, -nu, nu, NormalSpin(5));
    const double end = std::min(motion.end_before(1), 1.0);
    for (const double t : {0.25 * end, 0.5 * end, end}) {
      const MotionState now = motion.at(t);
      const Vector2d turning = now.center.velocity - now.contact_velocity;
      for (const Vector2d& v : {now.center.velocity, now.contact_velocity, turning, now.center.position}) {
        EXPECT_LE(std::abs(v.dot(turned(line))), 4 * DBL_EPSILON * now.center.velocity.norm());
      }
    }
  }
}

TEST(NumericMotion, SwingsFromASpeedOfWhichTheSquareIsNoNumber) {
  scene::Forces forces;
  forces.spring = {{3, 4}, 1};
  NumericMotion motion(Dynamics(sphere, forces), {scene::Solver::Method::cvode_adams, 1e-9});
  motion.begin_free({0, 0}, {{3e-200, 4e-200}, {0, 0, 0}}, NormalSpin(0));
  EXPECT_NEAR((motion.center(1).position - (1 - std::cos(1)) * Vector2d(3, 4)).norm(), 0, 1e-8);
}

// Its derivatives by the time grow by 1e50 from one to the next.
TEST(NumericMotion, EndsASlipOfWhichAPowerIsNoNumberByEveryMethod) {
  using Method = scene::Solver::Method;
  scene::Material ground = coulomb(0.34375);
  ground.turntable_rate = -8.75e-50;
  const Vector2d slip(6e-49, 2.75e-49);
  for (const Method method : {Method::automatic, Method::cvode_adams, Method::cvode_bdf, Method::arkode_erk,
                              Method::arkode_erk5, Method::dopri5, Method::dopri87}) {
    NumericMotion motion(Dynamics(sphere, {}), {method, 1e-9});
    motion.begin_sliding(ground, {2, -7}, {-9e-51, -7.5e-50}, slip, NormalSpin(0));
    const double end = motion.end_before(1);
    ASSERT_LT(end, 1e-47);
    for (int i = 0; i <= 100; ++i) {
      const MotionState now = motion.at(end * i / 100);
      const Vector2d left = now.contact_velocity - ground_velocity(ground, now.center.position);
      EXPECT_NEAR((left - (1 - i / 100.0) * slip).norm(), 0, 1e-7 * slip.norm()) << i;
    }
  }
}

// Its steps grow by 1e47.
TEST(NumericMotion, GoesOnFromASpeedThatHardlyDiffersFromZeroByEveryMethod) {
  using Method = scene::Solver::Method;
  scene::Forces forces;
  forces.gravity = {1, 2, -8};
  forces.spring = {{-1, 0.5}, 1.25};
  const Dynamics dynamics(sphere, forces);
  scene::Material ground(scene::Law::rough);
  ground.rolling_resistance = 0.02;
  NumericMotion from_rest(dynamics, {Method::automatic, 1e-12});
  from_rest.begin_resisted_rolling(ground, {0, 0}, {0, 0}, NormalSpin(0));
  for (const Method method : {Method::automatic, Method::cvode_adams, Method::cvode_bdf, Method::arkode_erk,
                              Method::arkode_erk5, Method::dopri5, Method::dopri87}) {
    NumericMotion motion(dynamics, {method, 1e-9});
    motion.begin_resisted_rolling(ground, {0, 0}, {-1e-47, -3e-47}, NormalSpin(0));
    for (const double t : {1e-40, 1e-3, 0.04, 0.5}) {
      const Vector2d expected = from_rest.center(t).position;
      EXPECT_NEAR((motion.center(t).position - expected).norm(), 0, 1e-8 * expected.norm() + 1e-80) << t;
    }
  }
}

// A abs(s) + b.s falls at the rate A^2 - b^2 on an incline.
TEST(NumericMotion, KeepsTheLinearInvariantOfAnIncline) {
  scene::Forces forces;
  forces.gravity = {1.2, -0.4, -9.7};
  const Dynamics dynamics(sphere, forces);
  const scene::Material ground = coulomb(0.25);
  NumericMotion motion(dynamics, {scene::Solver::Method::automatic, 1e-12});
  slide(motion, ground, {0, 0}, {{-0.5, 1.5}, {3, 1, 0}});
  const double decay = dynamics.slip_decay(0.25);
  const Vector2d b = dynamics.slipping();
  const auto invariant = [&](double t) {
    const Vector2d slip = motion.at(t).contact_velocity;
    return decay * slip.norm() + b.dot(slip);
  };
  const double start = invariant(0);
  const double rate = decay * decay - b.squaredNorm();
  const double end = motion.end_before(100);
  EXPECT_NEAR(end, start / rate, 1e-12 * end);
  for (const double part : {0.1, 0.4, 0.8, 0.99}) {
    EXPECT_NEAR(invariant(part * end), start - rate * part * end, 1e-12 * start);
  }
}

// Linear drag turns nothing on a turntable without it: r = r_C + E(t)(r_0 - r_C), angular rate kappa W.
TEST(NumericMotion, RollsOnATurntableInACircle) {
  const Dynamics dynamics(sphere, {});
  scene::Material ground(scene::Law::rough);
  ground.turntable_rate = 3;
  ground.turntable_center = {0.5, -0.25};
  const Vector2d start(1, 0.5);
  const Vector2d velocity(0.75, -1);
  for (const double accuracy : {1e-5, 1e-9, 1e-13}) {
    NumericMotion motion(dynamics, {scene::Solver::Method::automatic, accuracy});
    motion.begin_rolling(ground, start, velocity, NormalSpin());
    const double rate = dynamics.kappa * ground.turntable_rate;
    const Vector2d center = start + turned(velocity) / rate;
    for (const double t : {0.5, 3.0, 10.0}) {
      const Vector2d expected = center + Eigen::Rotation2Dd(rate * t) * (start - center);
      EXPECT_LE((motion.center(t).position - expected).norm(), accuracy * velocity.norm() * t);
      EXPECT_LE(motion.center(t).acceleration.norm(), motion.acceleration_bound(0, t) * (1 + accuracy));
    }
    EXPECT_EQ(motion.end_before(10), never);
  }
}

TEST(NumericMotion, DoesNotDependOnTheTimesAskedForToTheBit) {
  scene::Forces forces;
  forces.drag = {0.1, 1e-4, 0.2};
  forces.spring = {{0.2, 0.1}, 3};
  const Dynamics dynamics(sphere, forces);
  const scene::Material ground = coulomb(0.2, 2.5);
  const Twist twist{{0.2, -0.3}, {1, 2, 1}};
  NumericMotion once(dynamics, {scene::Solver::Method::automatic, 1e-9});
  NumericMotion often(dynamics, {scene::Solver::Method::automatic, 1e-9});
  slide(once, ground, {0.6, 0}, twist);
  slide(often, ground, {0.6, 0}, twist);
  for (int i = 0; i < 200; ++i) {
    often.end_before(0.001 * i);
    often.center(0.001 * i);
    often.forget_before(0.001 * i);
  }
  const MotionState a = once.at(0.2);
  const MotionState b = often.at(0.2);
  EXPECT_EQ(a.center.position, b.center.position);
  EXPECT_EQ(a.center.velocity, b.center.velocity);
  EXPECT_EQ(a.angular_velocity, b.angular_velocity);
  EXPECT_EQ(once.end_before(5), often.end_before(5));
  EXPECT_LT(once.end_before(5), 5);
}

TEST(NumericMotion, CountsTheStepsBetweenTwoTimes) {
  scene::Forces forces;
  forces.drag.quadratic = 0.5;
  NumericMotion motion(Dynamics(sphere, forces), {scene::Solver::Method::automatic, 1e-12});
  motion.begin_free({1, 2}, {{3, -4}, {1, 2, 3}}, NormalSpin(3));
  motion.reach(10);
  const std::uint64_t all = motion.steps(0, 10);
  EXPECT_GT(all, 10U);
  EXPECT_EQ(motion.steps(2, 2), 0U);
  EXPECT_EQ(motion.steps(0, 2) + motion.steps(2, 10), all);
  EXPECT_GT(motion.steps(2, 10), 0U);
}

}  // namespace
}  // namespace hybrid_sphere::testing::numeric_motion_test
