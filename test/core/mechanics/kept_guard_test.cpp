// Guards that a constraint itself keeps at 0: a body that has landed, a rope that is taut. The motion goes on
// along the edge, without a switch.

#include <gtest/gtest.h>

#include <cmath>

#include "core/mechanics/particle.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::kept_guard_test {
namespace {

using testing::vector;

constexpr double g = 9.81;

System<2> falling_particle() {
  return {{"x", "y"}, [](auto, const auto& q, const auto& v) { return v.dot(v) / 2 - g * q[1]; }};
}

Options accurate(double accuracy) {
  Options options;
  options.accuracy = accuracy;
  options.max_steps = 5000;
  return options;
}

/// The impulse at the landing is the only switch; afterwards energy and f stay.
void expect_one_landing(const Solution& solution, double accuracy, double largest_energy) {
  ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
  ASSERT_EQ(solution.switches().size(), 1u);
  const double energy = solution.switches()[0].energy_after;
  for (double t = solution.switches()[0].time; t < solution.end(); t += 0.05) {
    // An error of the accuracy in velocities, or in places, that count by their share of the energy.
    EXPECT_NEAR(solution.at(t).energy, energy, 4 * accuracy * largest_energy) << "t = " << t;
  }
}

class KeptGuard : public ::testing::TestWithParam<double> {};

TEST_P(KeptGuard, OfARopeThatGoesTaut) {
  System<2> particle = falling_particle();
  particle.constrain(
      "rope", [](auto, const auto& q, const auto& v) { return q.dot(v); },
      while_positive([](auto, const auto& q) { return q.dot(q) - 1; }));
  const Solution solution = solve(particle, {0, vector({0.4, 0}), vector({0.3, 0})}, 5, accurate(GetParam()));
  expect_one_landing(solution, GetParam(), 2 * g);
  const State end = solution.at(5);
  EXPECT_NEAR(end.q.norm(), 1, 10 * GetParam());
}

TEST_P(KeptGuard, OfABowlThatAParticleLandsIn) {
  System<2> particle = falling_particle();
  particle.constrain(
      "bowl", [](auto, const auto& q, const auto& v) { return v[1] - q[0] * v[0] / 2; },
      while_positive([](auto, const auto& q) { return q[0] * q[0] / 4 - q[1]; }));
  const Solution solution = solve(particle, {0, vector({1, 1}), vector({0.3, 0})}, 5, accurate(GetParam()));
  expect_one_landing(solution, GetParam(), 2 * g);
}

TEST_P(KeptGuard, OfAnInclineThatAParticleLandsOn) {
  System<2> particle = falling_particle();
  particle.constrain(
      "incline", [](auto, const auto&, const auto& v) { return v[1] - 0.3 * v[0]; },
      while_positive([](auto, const auto& q) { return 0.3 * q[0] - q[1]; }));
  const Solution solution = solve(particle, {0, vector({0, 1}), vector({0.3, 0})}, 5, accurate(GetParam()));
  ASSERT_EQ(solution.switches().size(), 1u);
  const Switch& landing = solution.switches()[0];
  const double left = 5 - landing.time;
  // Down the incline at the part g sin cos = g 0.3/1.09 of gravity.
  const double expected = landing.q[0] + landing.v_after[0] * left - g * 0.3 / 1.09 * left * left / 2;
  EXPECT_NEAR(solution.at(5).q[0], expected, GetParam() * std::abs(expected));
}

TEST_P(KeptGuard, OfAFloorThatMovesUpAndDown) {
  System<1> body({"x"}, [](auto, const auto&, const auto& v) { return v[0] * v[0] / 2; });
  body.constrain(
      "floor",
      [](auto t, const auto&, const auto& v) {
        using std::cos;
        return v[0] - cos(t);
      },
      while_positive([](auto t, const auto& q) {
        using std::sin;
        return sin(t) - q[0];
      }));
  const Solution solution = solve(body, {0, vector({0.5}), vector({0})}, 20, accurate(GetParam()));
  ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
  EXPECT_EQ(solution.switches().size(), 1u);
  EXPECT_NEAR(solution.at(20).q[0], std::sin(20.0), GetParam());
}

INSTANTIATE_TEST_SUITE_P(Accuracies, KeptGuard, ::testing::Values(1e-3, 1e-6, 1e-9, 1e-12));

// Released by its interval, the sphere of influence of the guard begins again: off its edge by the error of
// the motion, no more.
TEST(ReleasedGuard, GoesOnFreely) {
  System<2> particle = falling_particle();
  particle.constrain(
      "bowl", [](auto, const auto& q, const auto& v) { return v[1] - q[0] * v[0] / 2; },
      while_positive([](auto, const auto& q) { return q[0] * q[0] / 4 - q[1]; }));
  particle.constraints[0].schedule.end = 2;
  const Solution solution = solve(particle, {0, vector({1, 1}), vector({0.3, 0})}, 3, accurate(1e-9));
  ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
  ASSERT_EQ(solution.switches().size(), 2u);
  const Switch& released = solution.switches()[1];
  EXPECT_EQ(released.time, 2);
  const double expected = released.q[1] + released.v_after[1] - g / 2;
  EXPECT_NEAR(solution.at(3).q[1], expected, 1e-9 * g);
}

// A start at rest tells nothing of how long a motion's steps are.
TEST(StartAtRest, DoesNotLoosenTheAccuracyOfALongMotion) {
  System<1> oscillator({"x"},
                       [](auto, const auto& q, const auto& v) { return v[0] * v[0] / 2 - q[0] * q[0] / 2; });
  for (const double duration : {1e3, 1e6, 1e12}) {
    Options options;
    options.accuracy = 1e-6;
    options.max_steps = 2000;
    const Solution solution = solve(oscillator, {0, vector({1}), vector({0})}, duration, options);
    const double end = solution.end();
    EXPECT_NEAR(solution.at(end).q[0], std::cos(end), 1e-6) << "of " << duration << " s, at " << end;
    EXPECT_NEAR(solution.at(end).energy, 0.5, 1e-6);
  }
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::kept_guard_test
