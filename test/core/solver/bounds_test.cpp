// What the certificates rely on is never below the true value: bounds on speeds, accelerations, forcing and
// the curvature of the grip's margin, against motions that are sampled densely.

#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <functional>

#include "core/solver/random_equations.hpp"
#include "hybrid_sphere/ground/trace_curve.hpp"
#include "hybrid_sphere/solver/grip.hpp"
#include "hybrid_sphere/solver/numeric_motion.hpp"
#include "hybrid_sphere/solver/trajectory.hpp"

namespace hybrid_sphere::testing {
namespace {

using solver::Equations;
using solver::Instant;
using solver::Regime;
using solver::State;

constexpr Regime regimes[] = {Regime::free, Regime::rolling, Regime::sliding, Regime::resisted};
constexpr int stretches = 150;  // of each regime
constexpr int samples = 60;     // of each step
constexpr scene::Solver fine{scene::Solver::Method::dopri87, 1e-12};
constexpr double error = 1e-8;  // of the samples, relative: far above that of the integration

/// Calls use(trajectory, i) for the first steps of random motions, i being the node where a step begins.
template <class Use>
void for_steps(unsigned seed, Regime regime, const Use& use) {
  RandomStretches random(seed);
  for (int n = 0; n < stretches; ++n) {
    const RandomStretch stretch = random.next(regime);
    const Equations equations = stretch.equations();
    solver::Trajectory trajectory(fine);
    trajectory.begin(equations, stretch.start(equations));
    try {
      for (int i = 0; i < 12; ++i) trajectory.extend();
    } catch (const std::runtime_error&) {
      continue;  // it dies
    }
    SCOPED_TRACE(n);
    use(equations, trajectory, random);
    if (::testing::Test::HasFailure()) return;
  }
}

/// v' without the friction's own turning: what jerk is the derivative of.
Vector2d smooth_acceleration(const Equations& equations, const State& y) {
  const Instant now = equations.instant(y);
  const Vector2d all = equations.acceleration(y, now);
  return equations.is_dry() ? Vector2d(all + equations.center_decay() * equations.direction(y, now)) : all;
}

TEST(SpeedBound, IsNeverBelowTheSpeedTheAccelerationAndTheJerk) {
  for (const Regime regime : regimes) {
    double tightest = 1e300;
    for_steps(
        1, regime, [&](const Equations& equations, solver::Trajectory& trajectory, RandomStretches& random) {
          const std::size_t from = static_cast<std::size_t>(6 * random.part());
          const State& y = trajectory.node(from).y;
          const double duration = solver::time_of(trajectory.last()) - solver::time_of(y);
          const solver::SpeedBound bound(equations, y, duration);
          const solver::ForcingBound forcing(equations, bound);
          for (std::size_t i = from; i + 1 < trajectory.size(); ++i) {
            const double step = trajectory.node(i).step;
            for (int k = 0; k < samples; ++k) {
              const State a = trajectory.after(i, step * k / samples);
              const State b = trajectory.after(i, step * (k + 1) / samples);
              const Instant at_a = equations.instant(a);
              const Instant at_b = equations.instant(b);
              const double passed = solver::time_of(b) - solver::time_of(a);
              const double speed = at_a.velocity.norm();
              ASSERT_LE(speed, bound.speed * (1 + error));
              const double acceleration = equations.acceleration(a, at_a).norm();
              ASSERT_LE(acceleration, bound.acceleration * (1 + error));
              tightest = std::min(tightest, bound.acceleration / std::max(acceleration, 1e-300));
              const auto allowed = [&](double rate, const Vector2d& size) {
                return rate * passed * (1 + error) + error * size.norm();
              };
              const Vector2d smooth = smooth_acceleration(equations, a);
              ASSERT_LE((smooth_acceleration(equations, b) - smooth).norm(), allowed(bound.jerk, smooth));
              ASSERT_LE((at_b.force - at_a.force).norm(), allowed(forcing.force_rate, at_a.force));
              ASSERT_LE((at_b.spin - at_a.spin).norm(), allowed(forcing.spin_rate, at_a.spin));
            }
          }
        });
    EXPECT_LT(tightest, 1.5) << "a bound that is far off everywhere tests nothing";
  }
}

// The slope of the margin changes between two places by no more than the curvature there allows; and it is
// that of the margin.
void expect_curvature(const std::function<geometry::Jet(double)>& margin, double length, double curvature) {
  double scale = 0;
  for (int k = 0; k <= samples; ++k) scale = std::max(scale, std::abs(margin(length * k / samples).value));
  for (int k = 0; k < samples; ++k) {
    const double h = length / samples;
    const geometry::Jet a = margin(k * h);
    const geometry::Jet b = margin((k + 1) * h);
    const double noise = error * std::max({std::abs(a.slope), std::abs(b.slope), scale / length});
    ASSERT_LE(std::abs(b.slope - a.slope), curvature * h * (1 + error) + noise);
    ASSERT_NEAR(b.value - a.value, 0.5 * (a.slope + b.slope) * h,
                curvature * h * h / 6 + noise * h + error * scale);
  }
}

TEST(TheCurvatureOfTheGripsMargin, IsNeverBelowTheTrueOne) {
  for (const Regime regime : {Regime::rolling, Regime::resisted}) {
    for_steps(
        2, regime, [&](const Equations& equations, solver::Trajectory& trajectory, RandomStretches& random) {
          const solver::Grip grip(equations, random.size());
          for (std::size_t i = 0; i + 1 < trajectory.size(); ++i) {
            const double step = trajectory.node(i).step;
            const double low = 0.5 * random.part() * step;
            const State y = trajectory.after(i, low);
            const double length = step - low;
            const double duration = solver::time_of(trajectory.node(i + 1).y) - solver::time_of(y);
            const auto margin = [&](double x) { return grip.along_trajectory(trajectory.after(i, low + x)); };
            expect_curvature(margin, length, grip.curvature(y, length, duration));
            if (::testing::Test::HasFatalFailure()) return;
          }
        });
  }
}

// The angle of e follows theta' = F.J e. Nothing turns it more than a drive that itself turns away at its
// greatest rate, or first grows less along e.
TEST(TheTurningBound, IsNeverBelowWhatADriveTurns) {
  RandomStretches random(6);
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
    const double bound = solver::turning_bound(drive, unit(theta), drive.norm() + drift * x, drift, x);
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
TEST(TheCurvatureOfTheGripsMargin, IsNeverBelowTheTrueOneAlongTheDrive) {
  RandomStretches random(5);
  int checked = 0;
  for (int n = 0; n < 2 * stretches; ++n) {
    SCOPED_TRACE(n);
    const RandomStretch stretch = random.next(Regime::resisted);
    const Equations equations = stretch.equations();
    Vector2d nu = random.vector(stretch.velocity.norm());
    for (int i = 0; i < 8; ++i) {
      const State y = equations.start(nu);
      nu = nu.norm() * equations.instant(y).forcing.normalized();
    }
    nu += random.vector(std::pow(10, -6 * random.part()) * nu.norm());
    solver::Trajectory trajectory(fine);
    trajectory.begin(equations, equations.start(nu));
    const solver::Grip grip(equations, random.size());
    try {
      for (int i = 0; i < 4; ++i) trajectory.extend();
    } catch (const std::runtime_error&) {
      continue;  // it dies
    }
    for (std::size_t i = 0; i + 1 < trajectory.size(); ++i) {
      const double length = trajectory.node(i).step * std::pow(random.part(), 4);
      const double duration =
          solver::time_of(trajectory.after(i, length)) - solver::time_of(trajectory.node(i).y);
      const auto margin = [&](double x) { return grip.along_trajectory(trajectory.after(i, x)); };
      expect_curvature(margin, length, grip.curvature(trajectory.node(i).y, length, duration));
      if (::testing::Test::HasFatalFailure()) return;
      ++checked;
    }
  }
  EXPECT_GT(checked, stretches);
}

TEST(TheCurvatureOfTheGripsMargin, IsNeverBelowTheTrueOneWhereRollingBegins) {
  RandomStretches random(3);
  int departures = 0;
  for (int n = 0; n < 10 * stretches; ++n) {
    RandomStretch stretch = random.next(Regime::resisted);
    stretch.ground.rolling_resistance = 1e-3 * random.size();
    stretch.velocity = ground_velocity(stretch.ground, stretch.position);
    const Equations equations = stretch.equations();
    const State rest = equations.start(Vector2d::Zero());
    if (!(equations.instant(rest).forcing.norm() > 1.001 * equations.decay())) continue;
    const solver::Departure departure(equations);
    if (departure.end() == 0) continue;
    ++departures;
    SCOPED_TRACE(n);
    const solver::Grip grip(equations, random.size());
    const auto margin = [&](double tau) { return grip.along_departure(departure, tau); };
    expect_curvature(margin, departure.end(), grip.curvature(departure));
    for (int k = 0; k <= samples; ++k) {
      const double tau = departure.end() * k / samples;
      ASSERT_LE(departure.turning(tau).norm(), departure.turning_bound(1) * (1 + error));
    }
  }
  EXPECT_GT(departures, stretches);
}

void begin(NumericMotion& motion, const RandomStretch& stretch) {
  const NormalSpin spin(1);
  switch (stretch.regime) {
    case Regime::free: motion.begin_free(stretch.position, {stretch.velocity, {1, 2, 1}}, spin); break;
    case Regime::sliding: {
      const Vector2d sigma = stretch.slip + ground_velocity(stretch.ground, stretch.position);
      motion.begin_sliding(stretch.ground, stretch.position,
                           stretch.velocity - stretch.dynamics.kappa * sigma, stretch.slip, spin);
      break;
    }
    case Regime::resisted:
      motion.begin_resisted(stretch.ground, stretch.position, stretch.velocity, spin);
      break;
    default: motion.begin_rolling(stretch.ground, stretch.position, stretch.velocity, spin);
  }
}

// Between any two times; the box of a path between them holds it.
TEST(TheAccelerationsBound, HoldsForIntegratedMotionsBetweenAnyTwoTimes) {
  for (const Regime regime : regimes) {
    RandomStretches random(4);
    for (int n = 0; n < stretches; ++n) {
      const RandomStretch stretch = random.next(regime);
      SCOPED_TRACE(n);
      constexpr double accuracy = 1e-9;
      NumericMotion motion(stretch.dynamics, {scene::Solver::Method::automatic, accuracy});
      begin(motion, stretch);
      const double end = motion.end_before(1);
      for (int piece = 0; piece < 4; ++piece) {
        const double from = std::min(end, 1.0) * random.part();
        const double until = from + (std::min(end, 1.0) - from) * random.part();
        if (!(until > from)) continue;
        const double bound = motion.acceleration_bound(from, until);
        const CurvedPath path(motion, from, until);
        for (int k = 0; k <= samples; ++k) {
          const Placement center = motion.center(from + (until - from) * k / samples);
          // The place has roundings, and with it the spring's force.
          const Dynamics& d = stretch.dynamics;
          const double rounding =
              16 * DBL_EPSILON *
              (d.spring_rate * (center.position.norm() + d.spring_center.norm()) + d.free.norm());
          // A velocity is integrated to a fiftieth of the accuracy of the speeds so far, and drag makes an
          // acceleration of its error.
          const double integrated = 0.02 * accuracy * d.translational_drag * stretch.velocity.norm();
          ASSERT_LE(center.acceleration.norm(), bound * (1 + error) + rounding + integrated);
          const Vector2d slack = Vector2d::Constant(error * (1 + center.position.norm()));
          ASSERT_TRUE((center.position.array() >= (path.low - slack).array()).all());
          ASSERT_TRUE((center.position.array() <= (path.high + slack).array()).all());
        }
      }
    }
  }
}

// Between the nodes a trajectory is as good as at them: against one of far higher accuracy.
TEST(DenseOutput, IsAsGoodBetweenTheNodesAsTheAccuracySays) {
  using Method = scene::Solver::Method;
  for (const Method method : {Method::dopri5, Method::dopri87, Method::arkode_erk, Method::arkode_erk5,
                              Method::cvode_adams, Method::cvode_bdf}) {
    for (const Regime regime : regimes) {
      RandomStretches random(5);
      for (int n = 0; n < 12; ++n) {
        const RandomStretch stretch = random.next(regime);
        constexpr double accuracy = 1e-6;
        NumericMotion motion(stretch.dynamics, {method, accuracy});
        NumericMotion reference(stretch.dynamics, {Method::dopri87, 1e-13});
        begin(motion, stretch);
        begin(reference, stretch);
        SCOPED_TRACE(::testing::Message() << scene::to_string(method) << " " << n);
        const double horizon =
            std::min(0.9 * std::min(motion.end_before(0.5), reference.end_before(0.5)), 0.5);
        double speed = 0;
        double way = 0;
        for (int k = 1; k <= samples; ++k) {
          const double t = horizon * k / samples;
          const Placement a = motion.center(t);
          const Placement b = reference.center(t);
          speed = std::max(speed, b.velocity.norm() + stretch.slip.norm());
          way = std::max(way, (b.position - stretch.position).norm() + speed * t);
          ASSERT_LE((a.velocity - b.velocity).norm(), 2 * accuracy * speed) << t;
          ASSERT_LE((a.position - b.position).norm(), 2 * accuracy * way) << t;
        }
      }
    }
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing
