#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "interrupt/interrupt.hpp"
#include "motion/numeric_motion.hpp"
#include "support/interrupted.hpp"

namespace hybrid_sphere::testing::numeric_motion_end_test {
namespace {

using End = MotionEnd;

const Sphere sphere({1.0, 0.1, 0.0632455532033676});

scene::Material ground_of(scene::Law law, double friction, double turntable_rate = 0) {
  scene::Material ground(law);
  ground.friction = friction;
  ground.turntable_rate = turntable_rate;
  return ground;
}

/// The rolling sphere on a Coulomb turntable that a force drives to higher speed, until it slips.
struct DrivenOnATurntable {
  DrivenOnATurntable() { forces.wrench.force = {0, 0.5}; }

  scene::Forces forces;
  scene::Material ground = ground_of(scene::Law::coulomb, 0.2, 2.5);
  Vector2d start{0.5, 0};
  Vector2d velocity{0, 2.5};
  // Roots of abs(b - W J v(t)) = A with the cycloid of docs/theory.md 4, in 25 digits.
  double loss = 0.49489394326546562871;
  Vector2d place{0.27846775018671907707, 1.2549102399999994175};
  Vector2d speed{-0.89636445714285685661, 2.5185105155853227464};
};

TEST(NumericMotion, LosesItsGripOnADrivenTurntable) {
  const DrivenOnATurntable scene;
  for (const double accuracy : {1e-5, 1e-9, 1e-13}) {
    NumericMotion motion(Dynamics(sphere, scene.forces), {scene::Solver::Method::automatic, accuracy});
    motion.begin_rolling(scene.ground, scene.start, scene.velocity, NormalSpin());
    EXPECT_EQ(motion.end_before(0.4), never);
    const double end = motion.end_before(10);
    EXPECT_EQ(motion.end_reason(), End::grip_lost);
    // The reaction is a function of v alone, whose error is below accuracy times abs(v); it changes with the
    // time at the rate 3.6 of abs(v)/A.
    EXPECT_NEAR(end, scene.loss, 10 * accuracy);
    EXPECT_LE((motion.at(end).center.position - scene.place).norm(), 30 * accuracy);
  }
}

TEST(NumericMotion, SlidesOnFromTheLossOfGrip) {
  // 0.25 s after the loss, by the implicit Radau method of order 5 in 25 digits with 64, 128 and 256 steps;
  // the last two agree to 2e-15.
  const Vector2d slip(0.0296203294986141906, 0.0186491314032340573);
  const Vector2d place(-0.00045945920396669149, 1.87282533771861461);
  const DrivenOnATurntable scene;
  const Dynamics dynamics(sphere, scene.forces);
  const Vector2d p_c = scene.speed - dynamics.kappa * ground_velocity(scene.ground, scene.place);
  for (const double accuracy : {1e-5, 1e-9, 1e-12}) {
    NumericMotion motion(dynamics, {scene::Solver::Method::automatic, accuracy});
    motion.begin_sliding(scene.ground, scene.place, p_c, {0, 0}, NormalSpin());
    const MotionState now = motion.at(0.25);
    const double error =
        (now.contact_velocity - ground_velocity(scene.ground, now.center.position) - slip).norm();
    EXPECT_LE(error, std::max(accuracy, 1e-12) * scene.speed.norm());
    EXPECT_LE((now.center.position - place).norm(), std::max(accuracy, 1e-12));
  }
}

// On an incline that is too steep s = (b - A) tau along b from rest; with drag against the way of a spring
// the same series has to start a motion of many orders.
TEST(NumericMotion, StartsToSlideFromRest) {
  scene::Forces forces;
  forces.gravity = {7, 2, -6};
  const Dynamics dynamics(sphere, forces);
  const scene::Material ground = ground_of(scene::Law::coulomb, 0.1);
  NumericMotion motion(dynamics, {scene::Solver::Method::automatic, 1e-13});
  motion.begin_sliding(ground, {0, 0}, {0, 0}, {0, 0}, NormalSpin());
  const Vector2d b = dynamics.slipping();
  for (const double t : {0.0, 1e-3, 1.0, 50.0}) {
    const Vector2d slip = (1 - dynamics.slip_decay(0.1) / b.norm()) * t * b;
    EXPECT_LE((motion.at(t).contact_velocity - slip).norm(), 1e-13 * b.norm() * t);
  }
  EXPECT_EQ(motion.end_before(50), never);
}

// An onset and the motion with the same forces, started a little later from the onset's own values.
TEST(NumericMotion, StartsToSlideFromRestUnderDragAndASpring) {
  scene::Forces forces;
  forces.gravity = {7, 2, -6};
  forces.drag = {0.3, 0, 0.4};
  forces.spring = {{1, 2}, 2};
  const Dynamics dynamics(sphere, forces);
  const scene::Material ground = ground_of(scene::Law::coulomb, 0.1, 1.5);
  NumericMotion whole(dynamics, {scene::Solver::Method::automatic, 1e-13});
  const Vector2d start(0.5, -0.25);
  const Vector2d p_c = -dynamics.kappa * ground_velocity(ground, start);
  whole.begin_sliding(ground, start, p_c, {0, 0}, NormalSpin());
  for (const double later : {1e-4, 1e-2, 0.1}) {
    const MotionState there = whole.at(later);
    const Vector2d slip = there.contact_velocity - ground_velocity(ground, there.center.position);
    const Vector2d momentum = there.center.velocity - dynamics.kappa * there.contact_velocity;
    NumericMotion rest(dynamics, {scene::Solver::Method::automatic, 1e-13});
    rest.begin_sliding(ground, there.center.position, momentum, slip, NormalSpin());
    const MotionState a = whole.at(0.4);
    const MotionState b = rest.at(0.4 - later);
    EXPECT_LE((a.center.position - b.center.position).norm(), 1e-12);
    EXPECT_LE((a.contact_velocity - b.contact_velocity).norm(), 1e-12);
  }
}

// nu' = B - A e with B along nu: a parabola, v = (v_0 - (A - B) t), until nu is used up.
TEST(NumericMotion, StopsRollingWhenResistanceHasUsedItUp) {
  scene::Forces forces;
  forces.wrench.force = {0.03, 0};
  const Dynamics dynamics(sphere, forces);
  scene::Material ground = ground_of(scene::Law::rough, 0);
  ground.rolling_resistance = 0.01;
  NumericMotion motion(dynamics, {scene::Solver::Method::automatic, 1e-12});
  motion.begin_resisted_rolling(ground, {1, 1}, {0.5, 0}, NormalSpin());
  const double rate = dynamics.roll_decay(0.01) - dynamics.rolling().x();
  const double end = motion.end_before(100);
  EXPECT_EQ(motion.end_reason(), End::roll_used_up);
  EXPECT_NEAR(end, 0.5 / rate, 1e-12 * end);
  EXPECT_NEAR(motion.at(end).center.position.x(), 1 + 0.125 / rate, 1e-12);
  EXPECT_EQ(motion.at(end).center.velocity, Vector2d::Zero());
  EXPECT_NEAR(motion.at(0.25 * end).center.velocity.x(), 0.375, 1e-12);
}

// Resistance with quadratic drag on coulomb ground: the drag -c v^2 needs the reaction kappa c v^2 and the
// resistance A against it; under a spring that pulls ever harder grip is lost.
TEST(NumericMotion, LosesItsGripWhileItRollsAgainstResistance) {
  scene::Forces forces;
  forces.spring = {{0, 0}, 20};
  const Dynamics dynamics(sphere, forces);
  scene::Material ground = ground_of(scene::Law::coulomb, 0.2);
  ground.rolling_resistance = 0.01;
  NumericMotion motion(dynamics, {scene::Solver::Method::automatic, 1e-11});
  const double v_0 = 3;
  motion.begin_resisted_rolling(ground, {0, 0}, {v_0, 0}, NormalSpin());
  // x'' = -(1-kappa) k x - A = -g^2 x - A, lambda/m = x'' + k x = kappa k x - A = mu N/m
  const double pull = dynamics.slip_decay(0.2) * dynamics.kappa + dynamics.roll_decay(0.01);
  const double x = pull / (dynamics.kappa * 20);
  const double frequency = std::sqrt((1 - dynamics.kappa) * 20);
  const double offset = dynamics.roll_decay(0.01) / (frequency * frequency);
  const double amplitude = std::hypot(v_0 / frequency, offset);
  const double time = (std::asin((x + offset) / amplitude) - std::asin(offset / amplitude)) / frequency;
  const double end = motion.end_before(10);
  EXPECT_EQ(motion.end_reason(), End::grip_lost);
  EXPECT_NEAR(end, time, 1e-10 * time);
  EXPECT_NEAR(motion.at(end).center.position.x(), x, 1e-10 * x);
}

// A belt stretches a spring, (1 - kappa) k u t, until rolling resistance cannot hold the sphere any more.
TEST(NumericMotion, IsCarriedByABeltUntilASpringPullsItLoose) {
  scene::Forces forces;
  forces.spring = {{0, 0}, 2};
  const Dynamics dynamics(sphere, forces);
  scene::Material ground = ground_of(scene::Law::rough, 0);
  ground.rolling_resistance = 0.02;
  ground.belt = {0.25, 0};
  NumericMotion motion(dynamics, {scene::Solver::Method::automatic, 1e-9});
  motion.begin_sticking(ground, {0, 0}, NormalSpin());
  const double time = dynamics.roll_decay(0.02) / ((1 - dynamics.kappa) * 2 * 0.25);
  EXPECT_EQ(motion.end_before(0.5 * time), never);
  EXPECT_NEAR(motion.end_before(10 * time), time, 1e-13 * time);
  EXPECT_EQ(motion.end_reason(), End::breaks_loose);
  EXPECT_EQ(motion.at(time).center.velocity, ground.belt);
  EXPECT_NEAR(motion.at(time).center.position.x(), 0.25 * time, 1e-15);
}

TEST(NumericMotion, IsCarriedByATurntableOnAnArc) {
  scene::Material ground = ground_of(scene::Law::rough, 0, 0.5);
  ground.rolling_resistance = 0.5;
  NumericMotion motion(Dynamics(sphere, {}), {scene::Solver::Method::automatic, 1e-9});
  motion.begin_sticking(ground, {2, 0}, NormalSpin(0.5));
  EXPECT_EQ(motion.end_before(1000), never);
  for (const double t : {0.5, 10.0}) {
    const Vector2d expected(2 * std::cos(0.5 * t), 2 * std::sin(0.5 * t));
    // The angle is rounded; sine and cosine are good to an ulp.
    EXPECT_LE((motion.at(t).center.position - expected).norm(), 1e-14);
    EXPECT_EQ(motion.at(t).angular_velocity, Vector3d(0, 0, 0.5));
  }
}

TEST(NumericMotion, SaysWhenAndWhyItCannotGoOn) {
  scene::Forces forces;
  forces.drag.quadratic = 1;
  NumericMotion motion(Dynamics(sphere, forces), {scene::Solver::Method::automatic, 1e-9});
  motion.begin_free({0, 0}, {{1e300, 0}, Vector3d::Zero()}, NormalSpin());
  try {
    motion.at(1);
    FAIL() << "a speed whose square overflows was integrated";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find(" s into the segment: "), std::string::npos) << error.what();
  }
}

// Friction that is just as much as what drives the slip, or more: none grows.
TEST(NumericMotion, EndsAtOnceWhereTheSlipIsHeld) {
  const Sphere ring({1.0, 0.5, 0.5});  // kappa = 1/2
  scene::Forces forces;
  forces.gravity = {4, 0, -8};
  forces.drag.quadratic = 0.25;
  for (const double friction : {0.25, 0.26}) {
    NumericMotion motion(Dynamics(ring, forces), {scene::Solver::Method::automatic, 1e-9});
    motion.begin_sliding(ground_of(scene::Law::coulomb, friction), {0, 0}, {0, 0}, {0, 0}, NormalSpin());
    EXPECT_EQ(motion.end_before(10), 0) << friction;
  }
}

// Thousands of steps that have been taken already are looked through for the loss of grip.
TEST(NumericMotion, AsksWhetherToGoOnWhileItLooksForTheLossOfGrip) {
  scene::Material ground(scene::Law::coulomb);
  ground.friction = 1e3;
  scene::Forces forces;
  forces.gravity = {0, 0, -9.81};
  forces.drag.quadratic = 0.1;
  NumericMotion motion(Dynamics(sphere, forces), {scene::Solver::Method::rk4, 1e-9, 1e-3});
  motion.begin_rolling(ground, {0, 0}, {1, 0.5}, NormalSpin());
  motion.center(1);
  const QuestionsEvery questions(1);
  int asked = 0;
  const ShouldStop should_stop = [&] { return ++asked < 0; };
  const InterruptScope scope(should_stop);
  EXPECT_EQ(motion.end_before(0.999), never);
  EXPECT_GE(asked, 999);
}

}  // namespace
}  // namespace hybrid_sphere::testing::numeric_motion_end_test
