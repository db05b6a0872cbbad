// What the certificates rely on is never below the true value: bounds on speeds, accelerations, forcing and
// the curvature of the friction limit's margin, against motions that are sampled densely.

#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>

#include "core/motion/random_onsets.hpp"
#include "core/motion/random_steps.hpp"
#include "ground/trace_curve.hpp"
#include "motion/friction_limit.hpp"

namespace hybrid_sphere::testing::bounds_test {
namespace {

using numeric::EquationForm;
using numeric::Equations;
using numeric::Instant;
using numeric::State;

/// v' without the friction's own turning: what jerk is the derivative of.
Vector2d smooth_acceleration(const Equations& equations, const State& y) {
  const Instant now = equations.instant(y);
  const Vector2d all = equations.acceleration(y, now);
  return equations.is_dry() ? Vector2d(all + equations.center_decay() * equations.direction(y, now)) : all;
}

/// Of what SpeedBound and ForcingBound bound.
struct SharpnessOfSpeed {
  Sharpness speed, acceleration, jerk, roll, force_rate, spin_rate;

  void hold(const Equations& equations, const numeric::SpeedBound& bound, const State& a, const State& b) {
    const numeric::ForcingBound forcing(equations, bound);
    const Instant at_a = equations.instant(a);
    const Instant at_b = equations.instant(b);
    const double passed = numeric::time_of(b) - numeric::time_of(a);
    const auto hold_change = [&](Sharpness& of, const Vector2d& from, const Vector2d& to, double rate) {
      of.hold((to - from).norm(), rate * passed, error * from.norm());
    };
    speed.hold(at_a.velocity.norm(), bound.speed);
    acceleration.hold(equations.acceleration(a, at_a).norm(), bound.acceleration);
    hold_change(jerk, smooth_acceleration(equations, a), smooth_acceleration(equations, b), bound.jerk);
    hold_change(roll, at_a.nu, at_b.nu, bound.roll);
    hold_change(force_rate, at_a.force, at_b.force, forcing.force_rate);
    hold_change(spin_rate, at_a.spin, at_b.spin, forcing.spin_rate);
  }

  void expect_above(double least, bool turns) const {
    EXPECT_GT(acceleration.largest(), least);
    EXPECT_GT(jerk.largest(), least);
    EXPECT_GT(force_rate.largest(), least);
    if (turns) {
      EXPECT_GT(roll.largest(), least);
      EXPECT_GT(spin_rate.largest(), least);
    }
  }
};

TEST(SpeedBound, IsNeverBelowTheSpeedTheAccelerationAndTheJerk) {
  for (const EquationForm form : forms) {
    SharpnessOfSpeed sharpness;
    for_steps(1, form,
              [&](const Equations& equations, numeric::Trajectory& trajectory, RandomSegments& random) {
                const std::size_t from = static_cast<std::size_t>(6 * random.part());
                const State& y = trajectory.node(from).y;
                const double duration = numeric::time_of(trajectory.last()) - numeric::time_of(y);
                const numeric::SpeedBound bound(equations, y, duration);
                for (std::size_t i = from; i + 1 < trajectory.size(); ++i) {
                  const double step = trajectory.node(i).step;
                  for (int k = 0; k < samples; ++k) {
                    sharpness.hold(equations, bound, trajectory.after(i, step * k / samples),
                                   trajectory.after(i, step * (k + 1) / samples));
                    if (HasFatalFailure()) return;
                  }
                }
              });
    sharpness.expect_above(0.99, form != EquationForm::free && form != EquationForm::skidding);
  }
}

TEST(Bounds, TheCurvatureOfTheFrictionLimitsMarginIsNeverBelowTheTrueOne) {
  for (const EquationForm form :
       {EquationForm::rolling, EquationForm::resisted_rolling, EquationForm::skidding}) {
    Sharpness sharpness;
    for_steps(2, form,
              [&](const Equations& equations, numeric::Trajectory& trajectory, RandomSegments& random) {
                const numeric::FrictionLimit limit(equations, random.size());
                for (std::size_t i = 0; i + 1 < trajectory.size(); ++i) {
                  const double step = trajectory.node(i).step;
                  const double low = 0.5 * random.part() * step;
                  const State y = trajectory.after(i, low);
                  const double length = step - low;
                  const double duration = numeric::time_of(trajectory.node(i + 1).y) - numeric::time_of(y);
                  const auto margin = [&](double x) {
                    return limit.along_trajectory(trajectory.after(i, low + x));
                  };
                  expect_curvature(margin, length, limit.curvature(y, length, duration), sharpness);
                  if (::testing::Test::HasFatalFailure()) return;
                }
              });
    EXPECT_GT(sharpness.largest(), 0.75);
  }
}

// The angle of e follows theta' = F.J e. Nothing turns it more than a drive that itself turns away at its
// greatest rate, or first grows less along e.
TEST(Bounds, TheTurningBoundIsNeverBelowWhatADriveTurns) {
  RandomSegments random(6);
  double tightest = 1e300;
  for (int n = 0; n < 1000; ++n) {
    const double theta = 2 * M_PI * random.part();
    const auto unit = [](double angle) { return Vector2d(std::cos(angle), std::sin(angle)); };
    const double off = random.one_in(3) ? 0 : (random.part() - 0.5) * std::pow(10, -4 * random.part());
    const Vector2d drive = random.size() * unit(theta + off);
    const double drift = drive.squaredNorm() * random.size();
    // As far as half of the drive may be lost, and a little more.
    const double x = drive.norm() / drift * (random.one_in(2) ? random.part() : 0.6);
    const Vector2d rate = drift * unit(theta + (random.one_in(2) ? M_PI_2 : 2 * M_PI * random.part()));
    const double bound = numeric::turning_bound(drive, unit(theta), drive.norm() + drift * x, drift, x);
    const auto turning = [&](double at, double angle) {
      return (drive + at * rate).dot(unit(angle + M_PI_2));
    };
    constexpr int steps = 1000;
    const double h = x / steps;
    double angle = theta;
    double fastest = 0;
    for (int k = 0; k <= steps; ++k) {
      const double now = turning(k * h, angle);
      fastest = std::max(fastest, std::abs(now));
      const double middle = turning((k + 0.5) * h, angle + 0.5 * h * now);
      angle += h * turning((k + 0.5) * h, angle + 0.5 * h * middle);
    }
    ASSERT_LE(fastest, bound * (1 + 1e-4)) << n;
    tightest = std::min(tightest, bound / fastest);
  }
  EXPECT_LT(tightest, 1.001);
}

// What moves nearly as it is driven turns little, and is bounded by that.
TEST(Bounds, TheCurvatureOfTheFrictionLimitsMarginIsNeverBelowTheTrueOneAlongTheDrive) {
  RandomSegments random(5);
  int checked = 0;
  Sharpness sharpness;
  for (int n = 0; n < 2 * segments; ++n) {
    SCOPED_TRACE(n);
    const RandomSegment segment = random.next(EquationForm::resisted_rolling);
    const Equations equations = segment.equations();
    Vector2d nu = random.vector(segment.velocity.norm());
    for (int i = 0; i < 8; ++i) {
      const State y = equations.start(nu);
      nu = nu.norm() * equations.instant(y).forcing.normalized();
    }
    nu += random.vector(std::pow(10, -6 * random.part()) * nu.norm());
    numeric::Trajectory trajectory(fine);
    trajectory.begin(equations, equations.start(nu));
    const numeric::FrictionLimit limit(equations, random.size());
    try {
      for (int i = 0; i < 4; ++i) trajectory.extend();
    } catch (const std::runtime_error&) {
      continue;  // it dies
    }
    for (std::size_t i = 0; i + 1 < trajectory.size(); ++i) {
      const double length = trajectory.node(i).step * std::pow(random.part(), 4);
      const double duration =
          numeric::time_of(trajectory.after(i, length)) - numeric::time_of(trajectory.node(i).y);
      const auto margin = [&](double x) { return limit.along_trajectory(trajectory.after(i, x)); };
      expect_curvature(margin, length, limit.curvature(trajectory.node(i).y, length, duration), sharpness);
      if (::testing::Test::HasFatalFailure()) return;
      ++checked;
    }
  }
  EXPECT_GT(checked, segments);
  EXPECT_GT(sharpness.largest(), 0.9);
}

TEST(Bounds, TheCurvatureOfTheFrictionLimitsMarginIsNeverBelowTheTrueOneWhereRollingBegins) {
  RandomSegments random(3);
  Sharpness sharpness;
  int onsets = 0;
  for (int n = 0; n < 10 * segments; ++n) {
    RandomSegment segment = random.next(EquationForm::resisted_rolling);
    segment.ground.rolling_resistance = 1e-3 * random.size();
    segment.velocity = ground_velocity(segment.ground, segment.position);
    const Equations equations = segment.equations();
    const State rest = equations.start(Vector2d::Zero());
    if (!(equations.instant(rest).forcing.norm() > 1.001 * equations.decay())) continue;
    const numeric::SlipOnset onset(equations);
    if (onset.end() == 0) continue;
    ++onsets;
    SCOPED_TRACE(n);
    const numeric::FrictionLimit limit(equations, random.size());
    const auto margin = [&](double tau) { return limit.along_onset(onset, tau); };
    expect_curvature(margin, onset.end(), limit.curvature(onset), sharpness);
    for (int k = 0; k <= samples; ++k) {
      const double tau = onset.end() * k / samples;
      ASSERT_LE(onset.turning(tau).norm(), onset.turning_bound(1) * (1 + error));
    }
  }
  EXPECT_GT(onsets, segments);
  EXPECT_GT(sharpness.largest(), 0.9);
}

TEST(Bounds, TheCurvatureOfTheFrictionLimitsMarginIsNeverBelowTheTrueOneWhereASkidBegins) {
  RandomOnsets random(7);
  Sharpness sharpness;
  int onsets = 0;
  for (int n = 0; n < 3 * segments; ++n) {
    const RandomSegment segment = random.next(Start::slip_of_skid, false);
    const Equations equations = segment.equations();
    const numeric::SlipOnset onset = onset_of(segment, equations);
    if (onset.end() == 0 || segment.dynamics.spin.isZero(0)) continue;
    ++onsets;
    SCOPED_TRACE(n);
    const numeric::FrictionLimit limit(equations, random.numbers().size());
    const auto margin = [&](double tau) { return limit.along_onset(onset, tau); };
    expect_curvature(margin, onset.end(), limit.curvature(onset), sharpness);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(onsets, segments);
  EXPECT_GT(sharpness.largest(), 0.75);
}

// Between any two times; the box of a path between them holds it.
TEST(Bounds, TheAccelerationsBoundHoldsForIntegratedMotionsBetweenAnyTwoTimes) {
  for (const EquationForm form : forms) {
    RandomSegments random(4);
    Sharpness sharpness;
    for (int n = 0; n < segments; ++n) {
      const RandomSegment segment = random.next(form);
      SCOPED_TRACE(n);
      constexpr double accuracy = 1e-9;
      NumericMotion motion(segment.dynamics, {scene::Solver::Method::automatic, accuracy});
      begin(motion, segment);
      const double end = motion.end_before(1);
      for (int piece = 0; piece < 4; ++piece) {
        const double from = std::min(end, 1.0) * random.part();
        const double until = from + (std::min(end, 1.0) - from) * random.part();
        if (!(until > from)) continue;
        const double bound = motion.acceleration_bound(from, until);
        const CurvedPath path(motion, motion.curve(), from, until);
        for (int k = 0; k <= samples; ++k) {
          const PointState center = motion.center(from + (until - from) * k / samples);
          // The place has roundings, and with it the spring's force.
          const Dynamics& d = segment.dynamics;
          const double rounding =
              16 * DBL_EPSILON *
              (d.spring_rate * (center.position.norm() + d.spring_center.norm()) + d.free.norm());
          // A velocity is integrated to a fiftieth of the accuracy of the speeds so far, and drag makes an
          // acceleration of its error.
          const double integrated = 0.02 * accuracy * d.translational_drag * segment.velocity.norm();
          sharpness.hold(center.acceleration.norm(), bound, rounding + integrated);
          if (HasFatalFailure()) return;
          const Vector2d slack = Vector2d::Constant(error * (1 + center.position.norm()));
          ASSERT_TRUE((center.position.array() >= (path.low - slack).array()).all());
          ASSERT_TRUE((center.position.array() <= (path.high + slack).array()).all());
        }
      }
    }
    EXPECT_GT(sharpness.largest(), 0.99);
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::bounds_test
