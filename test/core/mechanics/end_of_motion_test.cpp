// Motions that end on the way: where no step is accurate enough, where they are told to, and what is kept of
// them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/mechanics/particle.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/mechanics/system.hpp"
#include "support/interrupted.hpp"

namespace hybrid_sphere::mechanics::end_of_motion_test {
namespace {

using testing::accurate, testing::level, testing::particle, testing::vector;

/// Every state from begin() to end() is there, and finite.
void expect_usable(const Solution& solution) {
  EXPECT_EQ(solution.status().time, solution.end());
  for (int i = 0; i <= 50; ++i) {
    const double t =
        i == 50 ? solution.end() : solution.begin() + (solution.end() - solution.begin()) * i / 50;
    const State state = solution.at(t);
    EXPECT_TRUE(state.q.allFinite() && state.v.allFinite() && std::isfinite(state.energy)) << "t = " << t;
    EXPECT_EQ(state.time, t);
  }
  EXPECT_THROW(solution.at(std::nextafter(solution.end(), INFINITY)), std::out_of_range);
}

void expect_part(const std::string& message, const std::string& part) {
  EXPECT_NE(message.find(part), std::string::npos) << '"' << part << "\" is not in: " << message;
}

/// x = t, up to x = 1/2, where a force of this size begins.
Solution into_a_wall(double force, double accuracy) {
  System<1> system(
      {"x"}, [](auto, const auto&, const auto& v) { return v[0] * v[0] / 2; },
      [=](auto, const auto& q, const auto&) {
        auto push = q;
        push[0] = q[0] < 0.5 ? 0.0 : -force;
        return push;
      });
  return solve(system, {0, vector({0}), vector({1})}, 1, accurate(accuracy));
}

// Stages of however short a step that lie beyond the edge are off by much more than the motion.
TEST(StepFailure, IsTheEndAtAForceThatBeginsMuchLargerThanTheMotion) {
  for (const double force : {1e20, 1e30}) {
    for (const double accuracy : {1e-3, 1e-6, 1e-9}) {
      SCOPED_TRACE(::testing::Message() << "force " << force << ", accuracy " << accuracy);
      const Solution solution = into_a_wall(force, accuracy);
      EXPECT_EQ(solution.status().stop, Stop::no_step) << solution.status().message;
      expect_part(solution.status().message, "no step that is accurate enough");
      expect_part(solution.status().message, "x = 0.5");
      // x and t are each off by a rounding of 0.5 in every step, and no step goes beyond the edge.
      const double rounding = static_cast<double>(solution.steps()) * 0.5 * DBL_EPSILON;
      EXPECT_NEAR(solution.end(), 0.5, rounding);
      EXPECT_LT(solution.at(solution.end()).q[0], 0.5 + rounding);
      expect_usable(solution);
      EXPECT_NEAR(solution.at(0.25).q[0], 0.25, rounding);
      EXPECT_EQ(solution.at(solution.end()).v[0], 1);
    }
  }
}

// v goes to -1 in a time of 2/force, and x comes back as it was.
TEST(StepFailure, IsNotTheEndAtAForceThatAStepCanFollow) {
  for (const double force : {1.0, 1e2, 1e3}) {
    for (const double accuracy : {1e-3, 1e-9}) {
      SCOPED_TRACE(::testing::Message() << "force " << force << ", accuracy " << accuracy);
      const Solution solution = into_a_wall(force, accuracy);
      ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
      const double time_beyond = std::min(0.5, 2 / force);
      EXPECT_NEAR(solution.at(1).v[0], 1 - force * time_beyond, accuracy);
    }
  }
}

// Two bodies that fall at each other, x'' = -1/x^2 from rest at 1: x = cos^2(s), t = (s + sin s cos s)/sqrt
// 2, s from 0 to pi/2. The speed has no bound.
TEST(StepFailure, IsTheEndWhereTheForceHasNoBound) {
  const double collision = M_PI / std::sqrt(8.0);
  for (const double accuracy : {1e-6, 1e-9}) {
    System<1> system({"x"}, [](auto, const auto& q, const auto& v) { return v[0] * v[0] / 2 + 1 / q[0]; });
    const Solution solution = solve(system, {0, vector({1}), vector({0})}, 2, accurate(accuracy));
    EXPECT_EQ(solution.status().stop, Stop::no_step) << solution.status().message;
    expect_part(solution.status().message, "shorter than the clock can resolve");
    // x = (9/2 (t0 - t)^2)^(1/3) at the end: a time left of x^1.5/2.1.
    EXPECT_NEAR(solution.end(), collision, accuracy);
    expect_usable(solution);
    EXPECT_LT(solution.at(solution.end()).q[0], 1e-3);
    for (const double s : {0.25, 0.75, 1.25}) {
      const double t = (s + std::sin(s) * std::cos(s)) / std::sqrt(2.0);
      EXPECT_NEAR(solution.at(t).q[0], std::pow(std::cos(s), 2), accuracy) << "s = " << s;
      EXPECT_NEAR(solution.at(t).v[0], -std::sqrt(2.0) * std::tan(s), 10 * accuracy) << "s = " << s;
    }
  }
}

// What came before is kept: switches, and what each constraint did.
TEST(StepFailure, KeepsWhatCameBefore) {
  System<2> system({"x", "y"}, [](auto, const auto& q, const auto& v) { return v.dot(v) / 2 + 1 / q[0]; });
  system.constrain("level", level, between(0.25, 0.5));
  const Solution solution = solve(system, {0, vector({1, 0}), vector({0, 1})}, 2);
  ASSERT_EQ(solution.status().stop, Stop::no_step) << solution.status().message;
  ASSERT_EQ(solution.switches().size(), 2u);
  EXPECT_EQ(solution.switches()[1].time, 0.5);
  EXPECT_EQ(solution.constraints()[0].applied, 1u);
  EXPECT_EQ(solution.constraints()[0].held, 0.25);
  EXPECT_EQ(solution.at(0.3).active, ActiveSet{0});
  EXPECT_EQ(solution.at(solution.end()).active, ActiveSet{});
  expect_usable(solution);
}

/// A mass on a spring, of angular frequency 1, with a constraint that comes and goes four times.
System<2> swinging() {
  System<2> system({"x", "y"},
                   [](auto, const auto& q, const auto& v) { return (v.dot(v) - q[0] * q[0]) / 2; });
  return system.constrain("level", level, while_positive([](auto, const auto& q) { return q[0]; }));
}
Initial swing_start() { return {2, vector({-1, 0}), vector({0, 1})}; }

/// The steps are the same; speeds of at most 1 carry the rounding of the time into the state.
void expect_same_place(const Solution& part, const Solution& whole, double t) {
  EXPECT_LE((part.at(t).q - whole.at(t).q).norm(), 4 * DBL_EPSILON * t) << "t = " << t;
  EXPECT_LE((part.at(t).v - whole.at(t).v).norm(), 4 * DBL_EPSILON * t) << "t = " << t;
}

TEST(MaxSteps, KeepsTheMotionUpToThere) {
  const Solution whole = solve(swinging(), swing_start(), 20);
  ASSERT_EQ(whole.status().stop, Stop::reached_end) << whole.status().message;
  Options options;
  options.max_steps = whole.steps() / 2;
  const Solution half = solve(swinging(), swing_start(), 20, options);
  EXPECT_EQ(half.status().stop, Stop::too_many_steps) << half.status().message;
  expect_part(half.status().message, std::to_string(options.max_steps));
  EXPECT_EQ(half.steps(), options.max_steps);
  EXPECT_LT(half.end(), whole.end());
  EXPECT_GE(half.switches().size(), 2u);
  expect_usable(half);
  expect_same_place(half, whole, half.end());
  options.max_steps = whole.steps();
  EXPECT_EQ(solve(swinging(), swing_start(), 20, options).status().stop, Stop::reached_end);
  options.max_steps = 0;
  const Solution nothing = solve(swinging(), swing_start(), 20, options);
  EXPECT_EQ(nothing.status().stop, Stop::too_many_steps);
  EXPECT_EQ(nothing.end(), 2);
  EXPECT_EQ(nothing.at(2).q, swing_start().q);
}

TEST(Monitor, IsToldAfterEachStepHowFarTheMotionHasCome) {
  std::vector<Progress> seen;
  Options options;
  options.monitor = [&](const Progress& progress) {
    seen.push_back(progress);
    return true;
  };
  const Solution watched = solve(swinging(), swing_start(), 20, options);
  const Solution alone = solve(swinging(), swing_start(), 20);
  ASSERT_EQ(watched.status().stop, Stop::reached_end) << watched.status().message;
  EXPECT_EQ(watched.steps(), alone.steps());
  EXPECT_EQ(watched.at(22).q, alone.at(22).q);
  ASSERT_EQ(seen.size(), watched.steps());
  double before = 2;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    EXPECT_EQ(seen[i].steps, i + 1);
    EXPECT_GT(seen[i].time, before) << "step " << i;
    before = seen[i].time;
    // Those before the step: at its end, the next one is still to come.
    std::uint64_t switches = 0;
    for (const Switch& change : watched.switches()) switches += change.time < seen[i].time ? 1U : 0U;
    EXPECT_EQ(seen[i].switches, switches) << "step " << i;
  }
  EXPECT_EQ(seen.back().time, watched.end());
}

TEST(Monitor, EndsTheMotionWhereItAnswersFalse) {
  const Solution whole = solve(swinging(), swing_start(), 20);
  for (const std::uint64_t last : {std::uint64_t{1}, std::uint64_t{7}, whole.steps() - 1}) {
    double time = 0;
    Options options;
    options.monitor = [&](const Progress& progress) {
      time = progress.time;
      return progress.steps < last;
    };
    const Solution solution = solve(swinging(), swing_start(), 20, options);
    EXPECT_EQ(solution.status().stop, Stop::cancelled) << solution.status().message;
    EXPECT_FALSE(solution.status().message.empty());
    EXPECT_EQ(solution.steps(), last);
    EXPECT_EQ(solution.end(), time);
    EXPECT_LT(solution.end(), whole.end());
    expect_usable(solution);
    expect_same_place(solution, whole, time);
  }
}

// A guard that the motion holds at 0 is looked at ahead, others have many roots in a step, and impulses are
// iterated: wherever the one question is asked that is answered so.
TEST(Monitor, IsHeardWhereverItIsAsked) {
  const hybrid_sphere::testing::QuestionsEvery questions(1);
  System<2> system = particle(1);
  system.constrain("level", level, while_positive([](auto, const auto& q) {
                     using std::sin;
                     return sin(40 * q[0]);
                   }));
  const Initial start{0, vector({0, 0}), vector({1, 1})};
  Options options;
  int asked = 0, last = 0;
  options.monitor = [&](const Progress&) { return ++asked != last; };
  ASSERT_EQ(solve(system, start, 0.3, options).status().stop, Stop::reached_end);
  const int all = std::exchange(asked, 0);
  ASSERT_GT(all, 20);
  for (last = 1; last <= all; ++last, asked = 0) {
    EXPECT_EQ(solve(system, start, 0.3, options).status().stop, Stop::cancelled) << last << " of " << all;
  }
  options.monitor = [&](const Progress&) -> bool {
    if (++asked == last) throw std::runtime_error("mine");
    return true;
  };
  for (last = 1; last <= all; ++last, asked = 0) {
    EXPECT_THROW(solve(system, start, 0.3, options), std::runtime_error) << last << " of " << all;
  }
}

// A motion that is complete was not cancelled.
TEST(Monitor, CannotEndWhatHasNoSteps) {
  Options options;
  options.monitor = [](const Progress&) { return false; };
  EXPECT_EQ(solve(particle(), {0, vector({0, 0}), vector({1, 0})}, 0, options).status().stop,
            Stop::reached_end);
}

TEST(MaxStep, IsNotExceeded) {
  const Initial start{0, vector({0, 0}), vector({1, 1})};
  const std::uint64_t free = solve(particle(), start, 10).steps();
  for (const double longest : {1.0, 0.1, 0.003}) {
    double before = 0, seen = 0;
    Options options;
    options.max_step = longest;
    options.monitor = [&](const Progress& progress) {
      seen = std::max(seen, progress.time - before);
      before = progress.time;
      return true;
    };
    const Solution solution = solve(particle(), start, 10, options);
    ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
    // The last one takes in what the roundings of the times, each at most that of 10, have left.
    const auto taken = static_cast<double>(solution.steps());
    EXPECT_LE(seen, longest + taken * 10 * DBL_EPSILON) << longest;
    EXPECT_GE(taken * longest, 10 * (1 - taken * DBL_EPSILON)) << longest;
    EXPECT_GT(solution.steps(), free) << longest;
    EXPECT_NEAR(solution.at(10).q[0], 10, taken * 10 * DBL_EPSILON) << longest;
  }
}

// A blow of a force cos^2 that lasts a hundredth of a second: momentum 100 w/2.
TEST(MaxStep, LooksAtAForceThatIsShort) {
  constexpr double middle = 5.0123, width = 0.01;
  System<1> system(
      {"x"}, [](auto, const auto&, const auto& v) { return v[0] * v[0] / 2; },
      [=](auto t, const auto& q, const auto&) {
        using std::cos;
        auto push = q;
        push[0] = 0;
        if (abs(t - middle) < width / 2)
          push[0] += 100 * cos(M_PI / width * (t - middle)) * cos(M_PI / width * (t - middle));
        return push;
      });
  Options options;
  options.max_step = width / 4;
  const Solution solution = solve(system, {0, vector({0}), vector({1})}, 10, options);
  ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
  // Velocities up to 1.5 count as this; the blow's edges have a kink in the second derivative.
  EXPECT_NEAR(solution.at(10).v[0], 1 + 100 * width / 2, 1.5 * options.accuracy);
}

TEST(MaxStep, LooksAtAGuardThatIsShort) {
  constexpr double middle = 5.0123, width = 0.01;
  System<2> system = particle();
  system.constrain("level", level, while_positive([=](auto, const auto& q) {
                     auto g = q[0];
                     g = -1;
                     if (abs(q[0] - middle) < width) g = width / 2 - abs(q[0] - middle);
                     return g;
                   }));
  Options options;
  options.max_step = width / 4;
  const Solution solution = solve(system, {0, vector({0, 0}), vector({1, 1})}, 10, options);
  ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
  ASSERT_EQ(solution.switches().size(), 2u);
  // x = t: roundings of both, and of the root.
  EXPECT_NEAR(solution.switches()[0].time, middle - width / 2, 4 * 10 * DBL_EPSILON);
  EXPECT_NEAR(solution.switches()[1].time, middle + width / 2, 4 * 10 * DBL_EPSILON);
}

// The velocities that are left form a circle, which has shrunk to a point just after the constraint began:
// the rounding of the clock decides whether the equations have a solution there.
TEST(EndOfMotion, AMotionThatCannotGoOnHasEveryStateUpToItsEnd) {
  System<2> system(
      {"x", "y"},
      [](auto t, const auto& q, const auto& v) {
        using std::cos;
        return (3.25 - cos(q[0]) / 4) * v[0] * v[0] / 2 + 65.0 / 128 * v[1] * v[1] - 0.1875 * v[0] * v[1] +
               q[0] * q[0] + 1.5 * cos(q[1]) + 2.0 * q[0] * q[1] - 0.625 * q[1] * cos(t);
      },
      [](auto, const auto&, const auto& v) { return (-1.5 * v + 1.375 / 8 * v * v.squaredNorm()).eval(); });
  system.constrain(
      "circle",
      [](auto t, const auto& q, const auto& v) {
        using std::cos;
        return (-2.0 - 1.625 * q[0]) * v[0] + (-1.25 - 0.875 * cos(q[1])) * v[1] - 1.25 * cos(t) -
               (v[0] * v[0] + v[1] * v[1] - 1.0) / 2;
      },
      from(0.25));
  for (const double accuracy : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8}) {
    SCOPED_TRACE(::testing::Message() << "accuracy " << accuracy);
    const Solution solution =
        solve(system, {0, vector({-1.5, -1.75}), vector({-0.625, -0.75})}, 0.375, accurate(accuracy));
    EXPECT_NE(solution.status().stop, Stop::reached_end);
    expect_usable(solution);
    double t = solution.end();
    for (int k = 0; k < 30; ++k, t = std::nextafter(t, 0.0)) {
      ASSERT_NO_THROW(EXPECT_TRUE(solution.at(t).v.allFinite())) << "t = " << t;
    }
  }
}

// At a time since 1970 the clock tells 1e-7 s apart: many steps of a fast motion are as short as that.
TEST(EndOfMotion, AMotionAtALateTimeIsItselfBetweenNodesThatTheClockHardlyTellsApart) {
  constexpr double rate = 1e3, start = 1e9, duration = 0.02;
  System<1> system({"x"}, [=](auto, const auto& q, const auto& v) {
    return (v[0] * v[0] - rate * rate * q[0] * q[0]) / 2;
  });
  const Solution solution = solve(system, {start, vector({0}), vector({rate})}, duration);
  ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
  for (int i = 0; i <= 1000; ++i) {
    const double t = std::min(start + duration * i / 1000, solution.end());
    EXPECT_NEAR(solution.at(t).q[0], std::sin(rate * (t - start)), 1e-9) << t - start;
  }
}

TEST(MaxStep, HasToBePositive) {
  const Initial start{0, vector({0, 0}), vector({1, 1})};
  for (const double longest : {0.0, -1.0, double(NAN), -double(INFINITY)}) {
    Options options;
    options.max_step = longest;
    EXPECT_THROW(solve(particle(), start, 1, options), std::invalid_argument) << longest;
  }
}

TEST(Stop, HaveTheNamesOfTheirEnumerators) {
  EXPECT_STREQ(to_string(Stop::reached_end), "reached_end");
  EXPECT_STREQ(to_string(Stop::singular), "singular");
  EXPECT_STREQ(to_string(Stop::no_direction), "no_direction");
  EXPECT_STREQ(to_string(Stop::inconsistent), "contradiction");
  EXPECT_STREQ(to_string(Stop::no_velocity), "no_velocity");
  EXPECT_STREQ(to_string(Stop::painleve), "painleve");
  EXPECT_STREQ(to_string(Stop::livelock), "livelock");
  EXPECT_STREQ(to_string(Stop::accumulation), "accumulation");
  EXPECT_STREQ(to_string(Stop::too_many_switches), "too_many_switches");
  EXPECT_STREQ(to_string(Stop::too_many_steps), "too_many_steps");
  EXPECT_STREQ(to_string(Stop::cancelled), "cancelled");
  EXPECT_STREQ(to_string(Stop::not_finite), "not_finite");
  EXPECT_STREQ(to_string(Stop::no_step), "no_step");
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::end_of_motion_test
