// Against a Taylor series of order 40 with 40 digits, step-by-step integration, and what must not matter.

#include "motion/attitude.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <random>
#include <utility>
#include <vector>

#include "core/motion/integrated.hpp"
#include "core/motion/spinning.hpp"
#include "motion/dry_friction_motion.hpp"
#include "motion/linear_motion.hpp"

namespace hybrid_sphere::testing::attitude_test {
namespace {

constexpr double unit = DBL_EPSILON;

const scene::SphereBody ball{1, 0.1, 0.0632455532033676};

Dynamics dynamics_of(const scene::Wrench& wrench) {
  scene::Forces forces;
  forces.wrench = wrench;
  return {Sphere(ball), forces};
}

LinearMotion on_turntable() {
  scene::Material disc(scene::Law::rough);
  disc.turntable_rate = 2;
  return LinearMotion::rolling(dynamics_of({}), disc, {0.5, 0.1}, {1, 0.3}, NormalSpin(3));
}

LinearMotion on_still_ground() {
  const Dynamics dynamics = dynamics_of({{0.3, 0.2}, {0, 0, 0.001}});
  return LinearMotion::rolling(dynamics, scene::Law::rough, {0.5, 0.1}, {1, 0.3},
                               NormalSpin(3, dynamics.normal_spin, 0, 0, 0));
}

DryFrictionMotion sliding() {
  scene::Material ground(scene::Law::coulomb);
  ground.friction = 0.2;
  return DryFrictionMotion::sliding(dynamics_of({{0.3, 0.2}, {0, 0, 0}}), ground, {0, 0}, {1, 0.3}, {3, -2},
                                    NormalSpin(3));
}

Quaterniond turned_by(Motion& motion, double tau, const SpinProfile& profile = {}) {
  Attitude attitude;
  attitude.begin(Quaterniond::Identity(), motion, profile);
  return attitude.at(tau, motion);
}

double distance(const Quaterniond& a, const Quaterniond& b) { return (a.coeffs() - b.coeffs()).norm(); }

Quaterniond integrated_turn(Motion& motion, double time, int intervals) {
  const auto slope = [&](const std::array<double, 4>& q, double t) {
    const Vector3d w = 0.5 * motion.angular_velocity(t);
    const Quaterniond change = Quaterniond(0, w.x(), w.y(), w.z()) * Quaterniond(q[0], q[1], q[2], q[3]);
    return std::array<double, 4>{change.w(), change.x(), change.y(), change.z()};
  };
  const auto q = integrated<4>({1, 0, 0, 0}, time, slope, intervals);
  return {q[0], q[1], q[2], q[3]};
}

TEST(Attitude, IsGoodToRoundingOnATurntableAndUnderATorque) {
  LinearMotion turntable = on_turntable();
  LinearMotion still = on_still_ground();
  // 400 rad and 280 rad: 1e-15 of that, half of it in a quaternion.
  EXPECT_LE(distance(turned_by(turntable, 10), {-0.1611905246001055157, 0.02037446809582625239,
                                                -0.9079509865640485058, -0.3862997564409353163}),
            0.5 * 400 * 1e-15);
  EXPECT_LE(distance(turned_by(still, 10), {-0.35907497086365757, 0.3692029197845544502,
                                            -0.8244027142076824214, -0.2347648485800836828}),
            0.5 * 280 * 1e-15);
}

TEST(Attitude, StopsAfterTheStepsThatItIsAllowedAndKeepsWhatItKnows) {
  // The axis turns as fast as the sphere.
  Spinning motion([](double t) { return Vector3d(20 * std::cos(30 * t), 20 * std::sin(30 * t), 10); });
  SpinProfile profile;
  profile.max_steps = 1000;
  Attitude attitude;
  attitude.begin(Quaterniond::Identity(), motion, profile);
  EXPECT_THROW(attitude.reach(1e6, motion), std::runtime_error);
  EXPECT_LE(attitude.steps(), 1000U + 8U);  // the last one may have been tried some times
  EXPECT_GT(attitude.reached(), 2);         // 23 rad/s, and a tenth of a radian in a step
  EXPECT_LT(attitude.reached(), 1e6);
  const std::uint64_t steps = attitude.steps();
  EXPECT_NEAR(attitude.at(attitude.reached(), motion).norm(), 1, 1e-15);
  EXPECT_EQ(attitude.steps(), steps);
}

TEST(Attitude, FollowsASlipThatEndsInACorner) {
  DryFrictionMotion motion = sliding();
  SpinProfile profile;
  profile.end = motion.end();
  for (const double share : {0.3, 0.999, 1.0}) {
    const double time = share * motion.end();
    // The reference does not know of the end, where w' is not smooth: the last of its 2000 intervals is worth
    // 1e-3 of 0.5 s, on which its error is a small part of the change of omega.
    const double tolerance = share == 1 ? 1e-9 : 50 * integration_error;
    EXPECT_LE(distance(turned_by(motion, time, profile), integrated_turn(motion, time, 2000)), tolerance);
  }
}

/// A slip up the slope that misses 0 by a part of itself, after which the friction turns round.
DryFrictionMotion thrown_up_a_slope(double speed, double miss) {
  scene::Material ground(scene::Law::coulomb);
  ground.friction = 0.05;
  return DryFrictionMotion::sliding(dynamics_of({{2, 0}, {0, 0, 0}}), ground, {0, 0}, {1, 0.3},
                                    {-speed, miss * speed}, NormalSpin(0.1));
}

SpinProfile course_of(const DryFrictionMotion& motion, double accuracy) {
  SpinProfile profile;
  profile.end = motion.end();
  profile.corner = motion.corner().time;
  profile.corner_width = motion.corner().width;
  profile.accuracy = accuracy;
  return profile;
}

// The reference takes 20000 steps of fourth order: across the corner it is good to the square of a step, that
// is 2e-9 of the angle. An estimate may be wrong by a factor of two.
TEST(Attitude, DoesNotStepOverACorner) {
  SpinProfile fine;
  fine.rule = SpinRule::rkmk4;
  for (const double speed : {0.001, 0.3, 4.0}) {
    for (const double miss : {1e-1, 1e-3, 1e-6}) {
      DryFrictionMotion motion = thrown_up_a_slope(speed, miss);
      const double time = 3 * motion.corner().time;
      fine.step = time / 20000;
      const Quaterniond expected = turned_by(motion, time, fine);
      const double angle = time * motion.angular_velocity(time).norm();
      for (const double accuracy : {2e-4, 2e-5, 1e-6, 1e-8}) {
        EXPECT_LE(distance(turned_by(motion, time, course_of(motion, accuracy)), expected),
                  (accuracy + 2e-9) * angle)
            << speed << ' ' << miss << ' ' << accuracy;
      }
    }
  }
}

// The length of a panel goes with the 16th root of the accuracy: two decades may not tell.
TEST(Attitude, TakesFewerStepsForALooserAccuracy) {
  LinearMotion motion = on_turntable();
  const auto steps = [&](double accuracy) {
    SpinProfile profile;
    profile.accuracy = accuracy;
    Attitude attitude;
    attitude.begin(Quaterniond::Identity(), motion, profile);
    attitude.at(10, motion);
    return static_cast<double>(attitude.steps());
  };
  EXPECT_LE(steps(2e-2), steps(2e-4));
  EXPECT_LT(steps(2e-4), steps(1e-8));
  EXPECT_LT(steps(1e-8), steps(1e-16));
  EXPECT_LT(1.5 * steps(2e-4), steps(1e-16));
}

TEST(Attitude, IsTheSameToTheLastBitWhateverTheOutputTimes) {
  LinearMotion motion = on_turntable();
  Attitude often;
  often.begin(Quaterniond::Identity(), motion);
  std::mt19937_64 engine(7);
  std::uniform_real_distribution<double> any(0, 5);
  std::vector<double> times(200);
  std::generate(times.begin(), times.end(), [&] { return any(engine); });
  for (const double time : times) {
    EXPECT_EQ(often.at(time, motion).coeffs(), turned_by(motion, time).coeffs()) << time;
  }
}

/// Remembers the first and the last instant that it was asked for.
class Recorded : public Motion {
 public:
  MotionState at(double tau) override {
    first = std::min(first, tau);
    last = std::max(last, tau);
    return inner.at(tau);
  }
  double acceleration_bound(double from, double until) override {
    return inner.acceleration_bound(from, until);
  }
  double end_before(double) override { return never; }
  MotionEnd end_reason() const override { return inner.end_reason(); }
  SpinProfile spin_profile() const override { return inner.spin_profile(); }

  LinearMotion inner = on_turntable();
  double first = never;
  double last = 0;
};

TEST(Attitude, GoesBackToWhereTheMotionHasBeenForgottenButNotBeyond) {
  Recorded motion;
  Attitude attitude;
  attitude.begin(Quaterniond::Identity(), motion);
  attitude.at(2, motion);
  const double from = attitude.needs_from();
  ASSERT_GT(from, 0);
  attitude.forget_before_now();
  const Quaterniond there = attitude.at(2.5, motion);
  attitude.at(10, motion);
  motion.first = never;
  EXPECT_EQ(attitude.at(2.5, motion).coeffs(), there.coeffs());
  EXPECT_GE(motion.first, from);
}

TEST(Attitude, IsOneExponentialWhereTheSpinIsConstant) {
  const Twist twist{{1, 2}, {0.3, -0.4, 1.2}};
  LinearMotion motion = LinearMotion::free(dynamics_of({}), {0, 0}, twist, {0, 0}, NormalSpin(1.2));
  SpinProfile profile;
  profile.constant = motion.steady();
  const double time = 1e5;
  const double half = 0.65e5;  // abs(omega) = 1.3
  const Vector3d axis = std::sin(half) / 1.3 * twist.angular_velocity;
  const Quaterniond expected(std::cos(half), axis.x(), axis.y(), axis.z());
  EXPECT_LE(distance(turned_by(motion, time, profile), expected), 4 * unit * half);
  // Nothing tells the stepping method so, but it needs only a few steps.
  Attitude attitude;
  attitude.begin(Quaterniond::Identity(), motion);
  EXPECT_LE(distance(attitude.at(time, motion), expected), 16 * unit * half);
  EXPECT_LE(attitude.steps(), 40u);
}

TEST(Attitude, RaisesTheTurnOfAPeriodToAPower) {
  LinearMotion motion = on_turntable();
  SpinProfile profile;
  profile.period = motion.period();
  // Two ways to the same angle, about 1e4 rad, each good to 1e-15 of it.
  const double time = 23.4 * motion.period();
  EXPECT_LE(distance(turned_by(motion, time, profile), turned_by(motion, time)), 1e4 * 1e-15);
  Attitude attitude;
  attitude.begin(Quaterniond::Identity(), motion, profile);
  const Quaterniond late = attitude.at(1e6, motion);
  EXPECT_NEAR(late.norm(), 1, 4 * unit);
  const auto steps = attitude.steps();
  EXPECT_LE(steps, 6000u);  // those of two periods
  attitude.at(1e6 + 1e-3, motion);
  EXPECT_LE(attitude.steps(), steps + 1);
}

TEST(Attitude, StepsOntoTheKinkAndNotAcross) {
  // omega_3 stops at once at 1.7 s; about one axis the angle is the integral of omega_3.
  const NormalSpin spin(3.4, 0, 0, 2, 0);
  const Twist twist{{0, 0}, {0, 0, 3.4}};
  LinearMotion motion = LinearMotion::free(dynamics_of({}), {0, 0}, twist, {0, 0}, spin);
  SpinProfile profile;
  profile.kink = spin.kink();
  EXPECT_DOUBLE_EQ(profile.kink, 1.7);
  const double half_angle = 0.25 * 3.4 * 1.7;
  const Quaterniond expected(std::cos(half_angle), 0, 0, std::sin(half_angle));
  for (const double time : {1.7, 1.8, 1e3}) {
    EXPECT_LE(distance(turned_by(motion, time, profile), expected), 8 * unit) << time;
  }
}

TEST(Attitude, DoesNotLookBeyondTheEnd) {
  Recorded motion;
  SpinProfile profile;
  profile.end = 1.234;
  turned_by(motion, profile.end, profile);
  EXPECT_LE(motion.last, profile.end);
  EXPECT_GT(motion.last, 0.9 * profile.end);
}

TEST(Attitude, StartsFromRestUnderATorque) {
  // About one axis: the angle is alpha t^2/2.
  for (const double alpha : {1e-9, 1.0, 1e9}) {
    LinearMotion motion =
        LinearMotion::free(dynamics_of({}), {0, 0}, Twist{}, {0, 0}, NormalSpin(0, alpha, 0, 0, 0));
    const double half_angle = 3;
    const double time = std::sqrt(4 * half_angle / alpha);
    const Quaterniond expected(std::cos(half_angle), 0, 0, std::sin(half_angle));
    EXPECT_LE(distance(turned_by(motion, time), expected), 64 * unit) << alpha;
  }
}

Vector3d smooth(double t) { return Vector3d(std::cos(t), std::sin(2 * t), 1); }

/// The turn over a time [s], with noise of this part of the angular velocity.
struct Noisy {
  explicit Noisy(double noise, double duration = 50)
      : motion([noise](double t) { return Vector3d(smooth(t) * (1 + noise * std::sin(1e12 * t))); }) {
    Attitude attitude;
    attitude.begin(Quaterniond::Identity(), motion);
    turn = attitude.at(duration, motion);
  }
  Spinning motion;
  Quaterniond turn;
};
constexpr double noisy_rate = 1.5;  // mean angular velocity [rad/s]
constexpr double noisy_angle = 50 * noisy_rate;

// What no panel resolves must not make them ever shorter.
TEST(Attitude, IsFollowedThroughNoiseOfTheAngularVelocity) {
  const Noisy still(0);
  for (const double noise : {1e-15, 1e-13, 1e-7}) {
    const Noisy noisy(noise);
    EXPECT_LE((noisy.turn.coeffs() - still.turn.coeffs()).norm(), (noise + 1e-15) * noisy_angle) << noise;
    EXPECT_LE(noisy.motion.asked, 4 * still.motion.asked) << noise;
  }
}

// A short panel does not distinguish noise from rounding of the same size: short panels stay short. The more
// noise, the sooner they become short, and the shorter. Each time includes some thousands of them.
TEST(Attitude, ComesToTheEndAlsoWhereNoiseLooksLikeRounding) {
  for (const auto& [noise, duration] : {std::pair(1e-12, 50.0), {1e-11, 50.0}, {1e-10, 20.0}, {1e-9, 1.0}}) {
    const Noisy still(0, duration);
    const Noisy noisy(noise, duration);
    EXPECT_LE((noisy.turn.coeffs() - still.turn.coeffs()).norm(), (noise + 1e-15) * duration * noisy_rate)
        << noise;
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::attitude_test
