// The power series with which a slip begins satisfies the equations as far as it says that it does.

#include "motion/slip_onset.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>

#include "core/motion/random_onsets.hpp"
#include "core/motion/random_steps.hpp"
#include "hybrid_sphere/simulation/simulation.hpp"
#include "support/case_count.hpp"

namespace hybrid_sphere::testing::slip_onset_test {
namespace {

using numeric::Equations;
using numeric::Instant;
using numeric::State;

/// dy/dtau by a difference quotient of order 4, wrong by step^4 times a part of the fifth coefficient.
State quotient(const numeric::SlipOnset& onset, double tau, double step) {
  const auto difference = [&](double h) { return State(onset.at(tau + h) - onset.at(tau - h)); };
  return (8 * difference(step * tau) - difference(2 * step * tau)) / (12 * step * tau);
}

double forces(const Equations& equations, const State& y) {
  const Instant now = equations.instant(y);
  return now.forcing.norm() + now.spin.norm() + equations.decays();
}

/// The largest part of the rates, of the vectors of the state, that the equations do not explain.
/// @param growth  to which accelerations are compared [m/s^2]
double unexplained(const Equations& equations, const numeric::SlipOnset& onset, double tau, double growth) {
  constexpr double step = 0.005;
  const State y = onset.at(tau);
  const State rest = quotient(onset, tau, step) - equations.derivative(y) / equations.pace(y);
  const double speed =
      equations.instant(y).velocity.norm() + y.head<2>().matrix().norm() + y.segment<2>(4).matrix().norm();
  const auto of = [&](Eigen::Index at, double size) {
    const double rounding = 8 * DBL_EPSILON * y.segment<2>(at).matrix().norm() / (step * tau);
    return std::max(0.0, rest.segment<2>(at).matrix().norm() - rounding) / size;
  };
  return std::max({of(0, growth), of(2, speed), of(4, growth)});
}

/// @param small  times the slip or the roll beside which another starts
void expect_onsets(Start start, double small, int cases) {
  RandomOnsets random(11);
  int onsets = 0;
  for (int n = 0; n < cases; ++n) {
    SCOPED_TRACE(::testing::Message() << static_cast<int>(start) << " " << n << " " << small);
    const RandomSegment segment = random.next(start, n % 2 == 0, small);
    const Equations equations = segment.equations();
    const numeric::SlipOnset onset = onset_of(segment, equations);
    if (onset.end() == 0) continue;
    ++onsets;
    for (const double part : {0.1, 0.4, 0.7, 0.98}) {
      const double tau = part * onset.end();
      const double size = forces(equations, onset.at(tau));
      ASSERT_LE(unexplained(equations, onset, tau, size), start == Start::both ? 1e-9 : 2e-12);
    }
  }
  EXPECT_GT(onsets, cases / 2);
}

// What the last coefficients and the next one leave, below rounding by themselves, is up to the order times
// that in the derivative, and relative to a thousandth of what drives.
TEST(SlipOnset, SatisfiesTheEquationsUpToItsEnd) {
  for (const Start start : starts) expect_onsets(start, 1, 1000);
}

// Their coefficients grow by as much from one to the next as the other vector is small.
TEST(SlipOnset, BesideAVectorThatHardlyDiffersFromZeroSatisfiesTheEquations) {
  for (const Start start : {Start::slip_beside_roll, Start::roll_beside_slip}) {
    for (const double small : {1e-12, 1e-26, 1e-50, 1e-80}) {
      expect_onsets(start, small, case_count(200));
    }
  }
}

// Where slip and rolling both start, what drives them changes by up to a billionth of the slower growth. A
// direction is rounded by as much as the forces are larger than the growth, and friction with it.
TEST(SlipOnset, OfBothVectorsIsStraightToABillionth) {
  RandomOnsets random(13);
  double largest = 0;
  for (int n = 0; n < 1000; ++n) {
    SCOPED_TRACE(n);
    const RandomSegment segment = random.next(Start::both, n % 2 == 0);
    const Equations equations = segment.equations();
    const numeric::SlipOnset onset = onset_of(segment, equations);
    if (onset.end() == 0) continue;
    const double tau = 0.98 * onset.end();
    const State y = onset.at(tau);
    const double growth = std::min(y.head<2>().matrix().norm(), y.segment<2>(4).matrix().norm()) / tau;
    const double excess = forces(equations, y) / growth;
    const double rounding = 4 * DBL_EPSILON * excess * excess;
    const double change = unexplained(equations, onset, tau, growth);
    ASSERT_LE(change, 1e-9 + rounding);
    largest = std::max(largest, change - rounding);
  }
  EXPECT_GT(largest, 0.5e-9);
}

TEST(SlipOnset, IsNoneWhereFrictionHolds) {
  RandomOnsets random(12);
  for (int n = 0; n < 1000; ++n) {
    RandomSegment segment = random.next(Start::slip, n % 2 == 0);
    const Equations equations = segment.equations();
    const double forcing = equations.instant(equations.start(Vector2d::Zero())).forcing.norm();
    segment.ground.friction = (1 + 1e-5 + random.numbers().part()) * forcing / segment.dynamics.slip_decay(1);
    const Equations held = segment.equations();
    EXPECT_EQ(numeric::SlipOnset(held).end(), 0) << n;
  }
}

/// How far the direction of what grows is from the integral of its turning, from 0 to tau, by Simpson's rule.
double unexplained_turn(const numeric::SlipOnset& onset, Start start, double tau) {
  constexpr int parts = 20;
  const Eigen::Index at = start == Start::roll_beside_slip ? 4 : 0;
  const auto direction = [&](double t) { return Vector2d(onset.at(t).segment<2>(at).matrix().normalized()); };
  const double first = 0.01 * tau;
  const double h = (tau - first) / parts;
  Vector2d turn = Vector2d::Zero();
  for (int k = 0; k < parts; ++k) {
    const double t = first + k * h;
    turn += h / 6 * (onset.turning(t) + 4 * onset.turning(t + 0.5 * h) + onset.turning(t + h));
  }
  return (direction(tau) - direction(first) - turn).norm();
}

TEST(SlipOnset, TheTurningBoundsOfAnOnsetAreNeverBelowTheTrueOnes) {
  for (const Start start :
       {Start::slip, Start::slip_of_skid, Start::slip_beside_roll, Start::roll_beside_slip}) {
    RandomOnsets random(14);
    Sharpness first, second;
    for (int n = 0; n < 300; ++n) {
      SCOPED_TRACE(::testing::Message() << static_cast<int>(start) << " " << n);
      const RandomSegment segment = random.next(start, false);
      const Equations equations = segment.equations();
      const numeric::SlipOnset onset = onset_of(segment, equations);
      const double end = onset.end();
      if (end == 0) continue;
      // What grows is less than the forces by up to a thousand, and its direction is rounded by as much more.
      ASSERT_LE(unexplained_turn(onset, start, end), 1e5 * DBL_EPSILON);
      for (int k = 1; k <= samples; ++k) {
        const double tau = end * k / samples;
        const double before = end * (k - 1) / samples;
        const Vector2d turning = onset.turning(tau);
        first.hold(turning.norm(), onset.turning_bound(1));
        second.hold((turning - onset.turning(before)).norm(), onset.turning_bound(2) * (tau - before),
                    error * turning.norm());
        if (HasFatalFailure()) return;
      }
    }
    EXPECT_GT(first.largest(), 0.99);
    EXPECT_GT(second.largest(), 0.99);
  }
}

// Quadratic drag goes with abs(v), whose series ends where v has doubled: on ground that hardly moves, at
// once.
TEST(SlipOnset, BesideQuadraticDragDoesNotHangOnGroundThatHardlyMoves) {
  for (const scene::Law law : {scene::Law::coulomb, scene::Law::rough}) {
    const auto end_on_belt = [&](double speed) {
      scene::Scene scene{};
      scene.sphere = {1, 1, 0.5};
      scene.surface.base = law;
      scene.surface.base.friction = law == scene::Law::coulomb ? 0.01 : 0;
      scene.surface.base.rolling_resistance = law == scene::Law::rough ? 0.002 : 0;
      scene.surface.base.belt = {0, speed};
      scene.initial_state.velocity = {0, speed};
      scene.forces.gravity = {0, 0, -1};
      scene.forces.wrench.force = {0, 0.4};
      scene.forces.drag.quadratic = 1;
      Simulation simulation(scene);
      EXPECT_NO_THROW(simulation.advance_to(1, {})) << speed;
      EXPECT_EQ(simulation.time(), 1) << speed;
      return simulation.state().position.y();
    };
    const double at_rest = end_on_belt(0);
    EXPECT_GT(at_rest, 0.1);
    for (const double speed : {1e-40, 1e-30, 1e-20, 1e-16, 1e-14, 1e-12, 1e-9}) {
      EXPECT_NEAR(end_on_belt(speed), at_rest, speed + 1e-9) << speed;
    }
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::slip_onset_test
