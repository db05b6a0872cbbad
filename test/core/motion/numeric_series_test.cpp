#include "motion/numeric_series.hpp"

#include <gtest/gtest.h>

#include <cfloat>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "core/motion/same_state.hpp"

namespace hybrid_sphere::testing::numeric_series_test {
namespace {

const Sphere sphere({1.0, 0.1, 0.0632455532033676});

scene::Material coulomb(double friction, double turntable_rate, double resistance = 0) {
  scene::Material ground(scene::Law::coulomb);
  ground.friction = friction;
  ground.turntable_rate = turntable_rate;
  ground.rolling_resistance = resistance;
  return ground;
}

scene::Forces forces(double quadratic_drag, double stiffness = 0) {
  scene::Forces forces;
  forces.drag.quadratic = quadratic_drag;
  forces.spring.stiffness = stiffness;
  return forces;
}

struct Case {
  std::string name;
  scene::Forces forces;
  std::function<void(NumericMotion&, const Dynamics&)> begin;
  double until;  // [s]
};

std::vector<Case> cases() {
  const Vector2d place(1, 2), velocity(3, -1), slip(2, 0.5);
  return {
      {"free, quadratic drag", forces(0.5),
       [=](NumericMotion& m, const Dynamics&) {
         m.begin_free(place, {velocity, {1, 2, 3}}, NormalSpin(3));
       },
       20},
      {"spring and quadratic drag", forces(0.5, 40),
       [=](NumericMotion& m, const Dynamics&) {
         m.begin_rolling(scene::Material(scene::Law::rough), place, velocity, NormalSpin(3));
       },
       5},
      {"slides on a turntable", forces(0),
       [=](NumericMotion& m, const Dynamics&) {
         m.begin_sliding(coulomb(0.05, 3), place, velocity, slip, NormalSpin(3));
       },
       5},
      {"slides to the end", forces(0),
       [=](NumericMotion& m, const Dynamics&) {
         m.begin_sliding(coulomb(0.5, 3), place, velocity, slip, NormalSpin(3));
       },
       5},
      {"slides and rolls against a resistance", forces(0.1),
       [=](NumericMotion& m, const Dynamics&) {
         m.begin_resisted_sliding(coulomb(0.1, 1, 0.02), place, velocity, slip,
                                  velocity - slip - ground_velocity(coulomb(0.1, 1, 0.02), place),
                                  NormalSpin(3));
       },
       2},
      {"a spin that friction ends", forces(0.5),
       [=](NumericMotion& m, const Dynamics& dynamics) {
         m.begin_rolling(scene::Material(scene::Law::rough), place, velocity,
                         {3, 0, dynamics.rotational_drag, 4, 0});
       },
       2},
  };
}

/// A motion and its dense output.
struct Followed {
  Followed(const Case& c, double accuracy)
      : dynamics(sphere, c.forces), motion(dynamics, {scene::Solver::Method::automatic, accuracy}) {
    c.begin(motion, dynamics);
    series.begin(motion);
    end = std::min(c.until, motion.end_before(c.until));
  }
  Dynamics dynamics;
  NumericMotion motion;
  NumericSeries series;
  double end;
};

void expect_near(const MotionState& a, const MotionState& b, const std::string& where) {
  // 4 are left out; the coefficients, of up to 4 times the size together, have 4 each, and 4 when evaluated.
  constexpr double rounding = 24 * DBL_EPSILON;
  const double speed = 4;  // in all cases
  EXPECT_LE((a.center.position - b.center.position).norm(), rounding * (b.center.position.norm() + 3))
      << where;
  EXPECT_LE((a.center.velocity - b.center.velocity).norm(), rounding * speed) << where;
  EXPECT_LE((a.contact_velocity - b.contact_velocity).norm(), rounding * speed) << where;
  EXPECT_LE((a.angular_velocity - b.angular_velocity).norm(), rounding * speed / 0.1) << where;
}

TEST(NumericSeries, IsTheMotionToRounding) {
  for (const Case& c : cases()) {
    for (const double accuracy : {1e-3, 1e-6, 1e-9, 1e-12}) {
      Followed one(c, accuracy);
      Followed other(c, accuracy);
      for (int i = 1; i < 2000; ++i) {
        const double tau = one.end * i / 2000;
        expect_near(one.series.at(tau), other.motion.at(tau), c.name + " at " + std::to_string(tau));
      }
    }
  }
}

// Where dry friction acts, a state of the motion takes right-hand sides, too.
TEST(NumericSeries, EvaluatesTheMotionRarely) {
  constexpr int outputs = 5000;
  for (std::size_t i = 2; i < 5; ++i) {
    const Case c = cases()[i];
    const auto evaluations = [&](Motion& (*followed)(Followed&)) {
      Followed one(c, 1e-9);
      one.motion.reach(one.end);
      const std::uint64_t of_steps = one.motion.evaluations();
      for (int k = 0; k < outputs; ++k) followed(one).at(one.end * k / outputs);
      return one.motion.evaluations() - of_steps;
    };
    const auto by_series = evaluations([](Followed& one) -> Motion& { return one.series; });
    const auto by_motion = evaluations([](Followed& one) -> Motion& { return one.motion; });
    EXPECT_GE(by_motion, std::uint64_t{outputs}) << c.name;
    EXPECT_LE(by_series, by_motion / 3) << c.name;
  }
}

TEST(NumericSeries, DoesNotDependOnTheTimesBefore) {
  std::minstd_rand random(5);
  for (const Case& c : cases()) {
    Followed often(c, 1e-9);
    for (int i = 0; i < 100; ++i) {
      const double tau = std::uniform_real_distribution<double>(0, often.end)(random);
      Followed once(c, 1e-9);
      expect_same(often.series.at(tau), once.series.at(tau), c.name + " at " + std::to_string(tau));
    }
  }
}

TEST(NumericSeries, KeepsToTheBitWhatIsConstant) {
  Followed free(cases()[0], 1e-9);
  Followed rolling(cases()[1], 1e-9);
  for (int i = 0; i < 1000; ++i) {
    const Vector3d omega = free.series.at(0.02 * i).angular_velocity;
    EXPECT_EQ(omega, Vector3d(1, 2, 3)) << i;
    const MotionState now = rolling.series.at(0.005 * i);
    EXPECT_EQ(now.angular_velocity.z(), 3) << i;
    EXPECT_EQ(now.contact_velocity, Vector2d::Zero()) << i;
  }
}

// Also where a velocity passes through 0.
TEST(NumericSeries, HasNoSlipWhereTheSphereRolls) {
  Followed one(cases()[1], 1e-9);
  for (int i = 1; i < 5000; ++i) {
    const MotionState now = one.series.at(0.001 * i);
    const Vector3d& omega = now.angular_velocity;
    const Vector2d slip = now.center.velocity - 0.1 * Vector2d(omega.y(), -omega.x()) - now.contact_velocity;
    EXPECT_LE(slip.norm(), 2 * DBL_EPSILON * now.center.velocity.norm()) << i;
  }
}

// Hardly any force acts, so that the first step is longer than anyone looks.
TEST(NumericSeries, LosesNothingNearTheBeginning) {
  const Case nearly_straight{"nearly straight", forces(1e-300),
                             [](NumericMotion& m, const Dynamics&) {
                               m.begin_free({1, 2}, {{1, -2}, {1, 2, 3}}, NormalSpin(3));
                             },
                             1};
  Followed one(nearly_straight, 1e-9);
  for (const double tau : {1e-6, 1e-3, 1.0}) {
    EXPECT_EQ(one.series.at(tau).center.position, Vector2d(1 + tau, 2 - 2 * tau)) << tau;
  }
}

// After the last step it is what the motion is; before what has been forgotten it says so.
TEST(NumericSeries, EndsWithTheMotion) {
  Followed one(cases()[3], 1e-9);
  ASSERT_LT(one.end, 5);
  expect_same(one.series.at(one.end), one.motion.at(one.end), "the end");
  const MotionState middle = one.series.at(0.5 * one.end);
  one.motion.forget_before(0.5 * one.end);
  expect_same(one.series.at(0.5 * one.end), middle, "kept");
  EXPECT_THROW(one.series.at(0.01 * one.end), NumericalError);
}

// A time before the end of a whole whose distance from the beginning rounds to its width.
TEST(HalvedInterval, LooksAtNoPartBeyondTheWhole) {
  const HalvedInterval::Whole whole{0x1p-60, 1};
  const double tau = 1;  // exactly before the end, 1 + 2^-60
  ASSERT_GE(tau - whole.from, whole.width);
  for (int last_level = 0; last_level < 5; ++last_level) {
    HalvedInterval interval;
    interval.find(tau, whole, last_level, [&](double from, double width) {
      EXPECT_LT(from, whole.from + whole.width) << width;
      return false;
    });
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::numeric_series_test
