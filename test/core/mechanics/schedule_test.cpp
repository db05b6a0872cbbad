// Constraints that come and go by the time, by a guard, and by both; several of them at once.

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <vector>

#include "core/mechanics/particle.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::schedule_test {
namespace {

using testing::level, testing::particle, testing::vector;

// The motions below are uniform, x = x0 + t: the integration does not err, and an instant is off by the
// roundings of x, of t and of a root, each of them of the size of a time of at most 20.
constexpr double instant_tolerance = 4 * 20 * DBL_EPSILON;

const auto sine = [](auto, const auto& q) {
  using std::sin;
  return sin(q[0]);
};

/// x = t; "level" has a guard as well as an interval.
Solution level_while(const Between& interval, double duration) {
  System<2> system = particle();
  system.constrain("level", level, while_positive(sine));
  system.constraints[0].schedule.begin = interval.begin;
  system.constraints[0].schedule.end = interval.end;
  return solve(system, {-0.5, vector({-0.5, 0}), vector({1, 1})}, duration);
}

void expect_instants(const Solution& solution, const std::vector<double>& instants) {
  EXPECT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
  ASSERT_EQ(solution.switches().size(), instants.size());
  for (std::size_t i = 0; i < instants.size(); ++i) {
    const Switch& change = solution.switches()[i];
    EXPECT_NEAR(change.time, instants[i], instant_tolerance) << "switch " << i;
    EXPECT_EQ(change.applied.size(), i % 2 == 0 ? 1u : 0u) << "switch " << i;
    EXPECT_EQ(change.released.size(), i % 2 == 0 ? 0u : 1u) << "switch " << i;
  }
}

TEST(IntervalAndGuard, HoldWhereBothSaySo) {
  // Begins and ends while the guard is positive: at these times exactly.
  const Solution inside = level_while(between(1, 2), 10);
  expect_instants(inside, {1, 2});
  EXPECT_EQ(inside.switches()[0].time, 1);
  EXPECT_EQ(inside.switches()[1].time, 2);
  // Begins while it is negative, ends while it is positive.
  const Solution over = level_while(between(-0.25, 7), 10);
  expect_instants(over, {0, M_PI, 2 * M_PI, 7});
  EXPECT_EQ(over.switches()[3].time, 7);
  expect_instants(level_while(from(4), 10), {2 * M_PI, 3 * M_PI});
  expect_instants(level_while(always(), 10), {0, M_PI, 2 * M_PI, 3 * M_PI});
}

TEST(IntervalAndGuard, NeverHoldWhereTheGuardIsNegativeAllAlong) {
  expect_instants(level_while(between(3.5, 6), 10), {});
  expect_instants(level_while(between(20, 30), 10), {});
  expect_instants(level_while(between(-5, -1), 10), {});
}

// The guard's instant and the interval's are one: one change, not two.
TEST(IntervalAndGuard, ThatChangeTogetherAreOneSwitch) {
  const auto hat = [](auto, const auto& q) { return (q[0] - 1) * (2 - q[0]); };
  for (const Between& interval : {between(1, 5), between(-5, 2), between(1, 2)}) {
    System<2> system = particle();
    system.constrain("level", level, while_positive(hat));
    system.constraints[0].schedule.begin = interval.begin;
    system.constraints[0].schedule.end = interval.end;
    expect_instants(solve(system, {0, vector({0, 0}), vector({1, 1})}, 5), {1, 2});
  }
}

TEST(IntervalAndGuard, HoldingAtTheStartHaveToBeSatisfied) {
  System<2> system = particle();
  system.constrain("level", level, while_positive(sine));
  const Initial inside{0, vector({1, 0}), vector({1, 1})};
  EXPECT_THROW(solve(system, inside, 1), std::invalid_argument);
  // Not yet in its interval, the guard alone does not make it hold.
  system.constraints[0].schedule.begin = 0.5;
  const Solution solution = solve(system, inside, 1);
  ASSERT_EQ(solution.switches().size(), 1u);
  EXPECT_EQ(solution.switches()[0].time, 0.5);
}

/// A unit mass in space, without forces.
System<3> particle_in_space() {
  return {{"x", "y", "z"}, [](auto, const auto&, const auto& v) { return v.dot(v) / 2; }};
}
const auto rail = [](auto, const auto&, const auto& v) { return v[0] - 2 * v[1]; };
const auto flat = [](auto, const auto&, const auto& v) { return v[2]; };

TEST(ConstraintForGood, HoldsOnWhereAnotherComesAndGoesByItsGuard) {
  System<3> system = particle_in_space();
  system.constrain("rail", rail, always());
  system.constrain("flat", flat, while_positive([](auto, const auto& q) { return (q[0] - 1) * (3 - q[0]); }));
  const Solution solution = solve(system, {0, vector({0, 0, 0}), vector({2, 1, 1})}, 4);
  ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
  ASSERT_EQ(solution.switches().size(), 2u);
  const Switch& applied = solution.switches()[0];
  EXPECT_NEAR(applied.time, 0.5, instant_tolerance);
  EXPECT_EQ(applied.applied, ActiveSet{1});
  EXPECT_EQ(applied.active, (ActiveSet{0, 1}));
  EXPECT_EQ(applied.rank, 2);
  // "flat" alone takes z': nothing of it is the rail's, but roundings of velocities of size 2.
  EXPECT_NEAR(applied.multipliers[0], 0, 8 * DBL_EPSILON);
  EXPECT_NEAR(applied.multipliers[1], -1, 8 * DBL_EPSILON);
  EXPECT_EQ(solution.switches()[1].active, ActiveSet{0});
  EXPECT_NEAR(solution.switches()[1].time, 1.5, instant_tolerance);
  EXPECT_EQ(solution.constraints()[0].held, 4);
  EXPECT_EQ(solution.constraints()[0].applied, 0u);
  EXPECT_NEAR(solution.constraints()[1].held, 1, 2 * instant_tolerance);
  EXPECT_EQ(solution.at(4).stage, 3);
  EXPECT_EQ(solution.at(4).active, ActiveSet{0});
  EXPECT_NEAR(solution.at(4).q[1], 4, instant_tolerance);
}

// One stands on its own, one comes by time while the other's guard is positive, and goes first.
TEST(ConstraintByTime, ComesAndGoesBesideAGuard) {
  System<3> system = particle_in_space();
  system.constrain("flat", flat, while_positive([](auto, const auto& q) { return (q[0] - 1) * (5 - q[0]); }));
  system.constrain("rail", rail, between(2, 3));
  const Solution solution = solve(system, {0, vector({0, 0, 0}), vector({1, 0.5, 1})}, 6);
  ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
  ASSERT_EQ(solution.switches().size(), 4u);
  const double instants[] = {1, 2, 3, 5};
  const ActiveSet active[] = {{0}, {0, 1}, {0}, {}};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(solution.switches()[i].time, instants[i], instant_tolerance) << i;
    EXPECT_EQ(solution.switches()[i].active, active[i]) << i;
  }
  EXPECT_EQ(solution.switches()[1].time, 2);
  EXPECT_EQ(solution.switches()[2].time, 3);
}

// x = t - 1 leaves the one side for the other; the two formulas have their roots to different roundings.
TEST(SimultaneousGuards, HandOverInOneSwitch) {
  System<3> system = particle_in_space();
  system.constrain("flat", flat, while_positive([](auto, const auto& q) {
                     using std::exp;
                     return 1 - exp(q[0]);
                   }));
  system.constrain("rail", rail, while_positive([](auto, const auto& q) {
                     using std::sin;
                     return sin(q[0] / 3);
                   }));
  const Solution solution = solve(system, {0, vector({-1, 0, 0}), vector({1, 0, 0})}, 3);
  ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
  ASSERT_EQ(solution.switches().size(), 1u);
  const Switch& change = solution.switches()[0];
  EXPECT_EQ(change.released, ActiveSet{0});
  EXPECT_EQ(change.applied, ActiveSet{1});
  EXPECT_NEAR(change.time, 1, instant_tolerance);
  // x' = 2 y' nearest to (1, 0): (4, 2)/5.
  EXPECT_NEAR(change.v_after[0], 0.8, 8 * DBL_EPSILON);
  EXPECT_NEAR(change.v_after[1], 0.4, 8 * DBL_EPSILON);
}

TEST(SimultaneousGuards, AreOneSwitchWhateverTheirSlopes) {
  for (const double slope : {1e-12, 1e-3, 1.0, 1e9}) {
    System<3> system = particle_in_space();
    system.constrain("flat", flat, while_positive([=](auto, const auto& q) {
                       using std::sin;
                       return slope * sin(q[0]);
                     }));
    system.constrain("rail", rail, while_positive([](auto, const auto& q) { return q[0] * (3 + q[0]); }));
    const Solution solution = solve(system, {0, vector({-1, 0, 0}), vector({1, 0, 1})}, 2);
    ASSERT_EQ(solution.switches().size(), 1u) << "slope " << slope;
    EXPECT_EQ(solution.switches()[0].applied, (ActiveSet{0, 1})) << "slope " << slope;
    EXPECT_EQ(solution.switches()[0].rank, 2) << "slope " << slope;
  }
}

const auto pulse = [](auto t, const auto&) { return (t - 1) * (2 - t); };

TEST(TimeGuard, IsAnIntervalEvenForWhatIsAtRest) {
  for (const double speed : {0.0, 1.0}) {
    System<2> system = particle();
    system.constrain("level", level, while_positive(pulse));
    const Solution solution = solve(system, {0, vector({0, 0}), vector({speed, speed})}, 3);
    expect_instants(solution, {1, 2});
    EXPECT_NEAR(solution.constraints()[0].held, 1, 2 * instant_tolerance) << "speed " << speed;
  }
}

// The clock shows 1e6 s: its rounding is in the instant.
TEST(TimeGuard, TakesTheClockAsItIs) {
  constexpr double start = 1e6;
  System<2> system = particle();
  system.constrain("level", level,
                   while_positive([=](auto t, const auto&) { return (t - start - 1) * (start + 2 - t); }));
  const Solution solution = solve(system, {start, vector({0, 0}), vector({1, 1})}, 3);
  ASSERT_EQ(solution.switches().size(), 2u);
  EXPECT_NEAR(solution.switches()[0].time - start, 1, 4 * DBL_EPSILON * start);
  EXPECT_NEAR(solution.switches()[1].time - start, 2, 4 * DBL_EPSILON * start);
}

TEST(TimeGuard, ChangesTogetherWithAGuardOfThePlace) {
  System<3> system = particle_in_space();
  system.constrain("flat", flat, while_positive([](auto t, const auto&) {
                     using std::sin;
                     return -sin(M_PI * t) * (1.5 - t);
                   }));
  system.constrain("rail", rail, while_positive([](auto, const auto& q) { return q[0]; }));
  // At t = 1 both, at t = 1.5 and 2 the first alone.
  const Solution solution = solve(system, {0.5, vector({-0.5, 0, 0}), vector({1, 0, 1})}, 1.25);
  ASSERT_EQ(solution.switches().size(), 2u);
  EXPECT_EQ(solution.switches()[0].applied, (ActiveSet{0, 1}));
  EXPECT_EQ(solution.switches()[1].released, ActiveSet{0});
  EXPECT_NEAR(solution.switches()[1].time, 1.5, instant_tolerance);
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::schedule_test
