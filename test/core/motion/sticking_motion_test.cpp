// No time at which a carried sphere breaks loose or slips is missed: against forces that are sampled densely.

#include "motion/sticking_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <functional>

#include "core/motion/random_equations.hpp"

namespace hybrid_sphere::testing::sticking_motion_test {
namespace {

using numeric::Equations;
using numeric::Instant;
using numeric::StickingMotion;

constexpr int samples = 1000;

/// What is limited, as a function of the time [m/s^2].
using Size = std::function<double(double)>;

struct Interval {
  double from;
  double until;
};

/// On a turntable up to a revolution; on a belt as long as the spring's force changes by a part, or many
/// times.
Interval random_interval(RandomSegments& random, const Equations& equations, const StickingMotion& sticking) {
  const Dynamics& dynamics = equations.dynamics();
  const double rate = std::abs(equations.turntable_rate());
  const double change = dynamics.spring_rate * sticking.speed();
  const double force = equations.instant(sticking.at(0)).force.norm() + dynamics.spin.norm();
  const double time = rate > 0 ? 7 * random.part() / rate : change > 0 ? force / change * random.size() : 1;
  const double from = random.one_in(2) ? 0 : time * random.part();
  return {from, from + time * random.part()};
}

/// The first time at which a sample is larger than the limit, by bisection from the one before.
double first_excess(const Size& size, double limit, const Interval& interval) {
  constexpr int halvings = 60;
  const auto time = [&](int k) { return interval.from + (interval.until - interval.from) * k / samples; };
  for (int k = 0; k <= samples; ++k) {
    if (!(size(time(k)) > limit)) continue;
    if (k == 0) return interval.from;
    double low = time(k - 1);
    double high = time(k);
    for (int i = 0; i < halvings; ++i) {
      const double middle = 0.5 * (low + high);
      (size(middle) > limit ? high : low) = middle;
    }
    return high;
  }
  return never;
}

/// A limit that is exceeded somewhere, often only just.
double random_limit(RandomSegments& random, const Size& size, const Interval& interval) {
  double least = never;
  double most = 0;
  for (int k = 0; k <= samples; ++k) {
    const double now = size(interval.from + (interval.until - interval.from) * k / samples);
    least = std::min(least, now);
    most = std::max(most, now);
  }
  const double part = random.one_in(2) ? random.part() : 1 - 1e-3 * random.part();
  return least + part * (most - least);
}

/// Counts what comes after the beginning.
/// @param terms  sum of the lengths of what makes the force, by which it is rounded
void expect_first(double found, const Size& size, double limit, double terms, const Interval& interval,
                  int& later) {
  constexpr double error = 1e-12;
  // The squares of force and limit, which are compared, are rounded by 8 units of that of the terms.
  const double rounding = 16 * DBL_EPSILON * terms * terms / limit;
  // Two crossings between two samples are seen only by the search.
  ASSERT_LE(found, first_excess(size, limit * (1 + error) + rounding, interval));
  if (found == never) return;
  ASSERT_GE(size(found), limit * (1 - error) - rounding);
  if (found > interval.from) ++later;
}

/// Of the sphere that is carried.
double terms(const Equations& equations, const StickingMotion& sticking, double limit,
             const Interval& interval) {
  double largest = 0;
  for (const double t : {interval.from, interval.until}) {
    const Instant now = equations.instant(sticking.at(t));
    const Dynamics& d = equations.dynamics();
    const double place = sticking.at(t).segment<2>(2).matrix().norm() + d.spring_center.norm();
    const double force = d.free.norm() + d.spring_rate * place + now.force.norm();
    largest =
        std::max(largest, force + d.spin.norm() + std::abs(equations.turntable_rate()) * sticking.speed());
  }
  return largest + limit;
}

TEST(StickingMotion, ACarriedSphereBreaksLooseWhereItsForceIsFirstTooLarge) {
  RandomSegments random(21);
  int later = 0;
  for (int n = 0; n < 1000; ++n) {
    SCOPED_TRACE(n);
    RandomSegment segment = random.next(numeric::EquationForm::resisted_rolling);
    const Equations unlimited = segment.equations();
    const StickingMotion moving(unlimited);
    const Interval interval = random_interval(random, unlimited, moving);
    const Size size = [&](double t) { return unlimited.instant(moving.at(t)).forcing.norm(); };
    const double limit = random_limit(random, size, interval);
    segment.ground.rolling_resistance = limit / segment.dynamics.roll_decay(1);
    const Equations equations = segment.equations();
    const double found = StickingMotion(equations).first_breaking(interval.from, interval.until);
    const double all = terms(equations, moving, limit, interval);
    expect_first(found, size, equations.decay(), all, interval, later);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(later, 300);
}

TEST(StickingMotion, ACarriedSphereSlipsWhereItsReactionIsFirstTooLarge) {
  RandomSegments random(22);
  int later = 0;
  for (int n = 0; n < 1000; ++n) {
    SCOPED_TRACE(n);
    const RandomSegment segment = random.next(numeric::EquationForm::resisted_rolling);
    const Equations equations = segment.equations();
    const StickingMotion sticking(equations);
    const Interval interval = random_interval(random, equations, sticking);
    const Size size = [&](double t) {
      const Instant now = equations.instant(sticking.at(t));
      return (equations.turntable_rate() * turned(now.velocity) - now.force).norm();
    };
    const double limit = random_limit(random, size, interval);
    const double friction = limit / segment.dynamics.center_decay(1);
    const double found = sticking.first_slipping(friction, interval.from, interval.until);
    expect_first(found, size, limit, terms(equations, sticking, limit, interval), interval, later);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(later, 250);
}

}  // namespace
}  // namespace hybrid_sphere::testing::sticking_motion_test
