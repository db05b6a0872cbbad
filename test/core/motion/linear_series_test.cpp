#include "motion/linear_series.hpp"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "core/motion/same_state.hpp"

namespace hybrid_sphere::testing::linear_series_test {
namespace {

Dynamics dynamics_of(double translational, double rotational, double stiffness) {
  scene::Forces forces;
  forces.gravity = {0.4, -0.3, -9.8};
  forces.wrench = {{0.2, 0.1}, {0.01, -0.02, 0.003}};
  forces.drag.translational = translational;
  forces.drag.rotational = rotational;
  forces.spring = {{0.5, -0.2}, stiffness};
  return {Sphere({0.7, 0.2, 0.1264911064067352}), forces};
}

NormalSpin normal_spin(const Dynamics& dynamics, double friction) {
  return {3, dynamics.normal_spin, dynamics.rotational_drag, friction, 0.5};
}

LinearMotion rolling(const Dynamics& dynamics, double turntable_rate) {
  scene::Material ground(scene::Law::rough);
  ground.belt = {0.3, -0.1};
  ground.turntable_rate = turntable_rate;
  ground.turntable_center = {0.4, 0.7};
  return LinearMotion::rolling(dynamics, ground, {1.2, -0.7}, {0.8, 0.5}, normal_spin(dynamics, 0.7));
}

LinearMotion free(const Dynamics& dynamics) {
  return LinearMotion::free(dynamics, {1.2, -0.7}, {{0.8, 0.5}, {1, -2, 3}}, {0.4, 0.9},
                            normal_spin(dynamics, 0));
}

struct Case {
  std::string name;
  LinearMotion motion;
  double until;  // [s]
};

std::vector<Case> cases() {
  return {
      {"circle", rolling(dynamics_of(0, 0, 0), 3), 20},
      {"turntable with drag", rolling(dynamics_of(0.3, 0.002, 0), -2), 20},
      {"growing", rolling(dynamics_of(0, 0.02, 2), 5), 20},
      {"stiff", rolling(dynamics_of(9, 0.05, 0.01), 0), 20},
      {"spring", free(dynamics_of(0, 0, 5)), 20},
      {"damped spring", free(dynamics_of(0.3, 0.002, 5)), 20},
      {"drag of the centre", free(dynamics_of(0.3, 0, 0)), 20},
      {"drag of the spin", free(dynamics_of(0, 0.002, 0)), 20},
      {"slow drag", free(dynamics_of(1e-10, 0, 0)), 20},
      {"fast drag", free(dynamics_of(1e6, 10, 0)), 1e-4},
  };
}

/// Relative to the greatest of all that a state is the sum of.
void expect_near(const MotionState& a, const MotionState& b, const std::string& where) {
  constexpr double rounding = 32 * DBL_EPSILON;
  const double speed = 3 + b.center.velocity.norm() + b.contact_velocity.norm();
  const double size = rounding * (3 + b.center.position.norm() + speed);
  EXPECT_LE((a.center.position - b.center.position).norm(), size) << where;
  EXPECT_LE((a.center.velocity - b.center.velocity).norm(), size) << where;
  EXPECT_LE((a.contact_velocity - b.contact_velocity).norm(), 5 * size) << where;
  EXPECT_LE((a.angular_velocity - b.angular_velocity).norm(), size / 0.2 * 5) << where;
}

TEST(LinearSeries, IsTheMotionToRounding) {
  for (Case& c : cases()) {
    LinearMotion same = c.motion;
    LinearSeries series;
    series.begin(c.motion);
    for (int i = 1; i <= 2000; ++i) {
      const double tau = c.until * i / 2000;
      expect_near(series.at(tau), same.at(tau), c.name + " at " + std::to_string(tau));
    }
  }
}

// The place, relative to the way since the beginning.
TEST(LinearSeries, LosesNothingNearTheBeginning) {
  for (Case& c : cases()) {
    LinearMotion same = c.motion;
    LinearSeries series;
    series.begin(c.motion);
    const Vector2d start = same.at(0).center.position;
    EXPECT_EQ(series.at(0).center.position, start);
    for (const double tau : {1e-12, 1e-6, 1e-3}) {
      if (tau > c.until) continue;
      const Vector2d exact = same.at(tau).center.position;
      const double tolerance = 16 * DBL_EPSILON * (exact - start).norm() + DBL_EPSILON * start.norm();
      EXPECT_LE((series.at(tau).center.position - exact).norm(), tolerance) << c.name << " at " << tau;
    }
  }
}

TEST(LinearSeries, DoesNotDependOnTheTimesBefore) {
  std::minstd_rand random(5);
  for (Case& c : cases()) {
    LinearSeries often;
    often.begin(c.motion);
    for (int i = 0; i < 300; ++i) {
      const double tau = std::uniform_real_distribution<double>(0, c.until)(random);
      LinearSeries once;
      once.begin(c.motion);
      expect_same(often.at(tau), once.at(tau), c.name + (" at " + std::to_string(tau)));
    }
  }
}

// Far beyond the resolution of its intervals every time is one of its own.
// Intervals are powers of two: the last figure of a width may be just below one, in any unit.
TEST(LinearSeries, DoesNotDependOnTheUnitOfTime) {
  const auto velocity = [](double rate, double unit) {
    scene::Forces forces;
    forces.wrench.force = {-0.5 / unit / unit, -0.25 / unit / unit};
    forces.drag.translational = rate / unit;
    LinearMotion motion =
        LinearMotion::free({Sphere({1, 0.125, 0.0625}), forces}, {0, 0},
                           {{0.3 / unit, 0.7 / unit}, {0, 0, 0}}, {0.3 / unit, 0.7 / unit}, NormalSpin(0));
    LinearSeries series;
    series.begin(motion);
    return Vector2d(unit * series.at(0.375 * unit).center.velocity);
  };
  for (const double rate : {0.7, 1.4, 2.8, std::nextafter(1.4, 2.0), std::nextafter(1.4, 1.0)}) {
    for (int k = -30; k <= 30; ++k) {
      EXPECT_EQ(velocity(rate, std::ldexp(1.0, k)), velocity(rate, 1)) << rate << ", 2^" << k;
    }
  }
}

TEST(LinearSeries, FollowsAFastMotionToALateTime) {
  LinearMotion motion = rolling(dynamics_of(0, 0, 0), 1e9);
  LinearMotion same = motion;
  LinearSeries series;
  series.begin(motion);
  for (const double tau : {1e8, 1e8 + 1, 1e15}) {
    EXPECT_EQ(series.at(tau).center.position, same.at(tau).center.position) << tau;
  }
}

// A sphere that a spring and drag have brought to rest is at rest in every digit, as in the motion itself.
TEST(LinearSeries, ComesToRest) {
  scene::Forces forces;
  forces.spring = {{0.1, 0.2}, 100};
  forces.drag.translational = 10;
  const Dynamics dynamics(Sphere({1, 1, 0.6}), forces);
  LinearMotion motion = LinearMotion::rolling(dynamics, scene::Law::rough, {7, 3}, {0, 0}, NormalSpin(0));
  LinearSeries series;
  series.begin(motion);
  for (const double tau : {600.0, 1234.5, 3000.0}) {
    const MotionState now = series.at(tau);
    EXPECT_EQ(now.center.velocity, Vector2d(0, 0)) << tau;
    EXPECT_EQ(now.center.acceleration, Vector2d(0, 0)) << tau;
    EXPECT_EQ(now.angular_velocity, Vector3d(0, 0, 0)) << tau;
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::linear_series_test
