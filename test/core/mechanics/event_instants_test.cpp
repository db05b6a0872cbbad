// When events occur: once for each crossing, in half-open intervals, also at instants at which something else
// happens.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "hybrid_sphere/mechanics/event.hpp"
#include "hybrid_sphere/mechanics/plant.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::event_instants_test {
namespace {

constexpr double gravity = 10;  // [m/s^2]

System<1> particle(double force = 0) {
  return {{"x"},
          [](auto, const auto&, const auto& v) { return v[0] * v[0] / 2; },
          [force](auto, const auto&, const auto&) { return force; }};
}

std::size_t events(const std::vector<Switch>& switches, std::size_t which) {
  std::size_t count = 0;
  for (const Switch& s : switches) {
    count += static_cast<std::size_t>(std::count(s.events.begin(), s.events.end(), which));
  }
  return count;
}

/// v' = 1, and v is set to 0 whenever it reaches 1.
class IntegrateAndFire : public ::testing::TestWithParam<Crossing> {
 protected:
  System<1> neuron() const {
    System<1> neuron = particle(1);
    neuron.event(
        "fire", [](double, const Vector&, const Vector& v) { return v[0] - 1; }, GetParam(),
        [](double, const Vector&, const Vector&) { return Vector{0}; });
    return neuron;
  }
};

TEST_P(IntegrateAndFire, FiresAgainAfterEachReset) {
  const Solution motion = solve(neuron(), {0, {0.0}, {0.0}}, 5.5);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  ASSERT_EQ(motion.switches().size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(motion.switches()[i].time, double(i + 1), 1e-13);
  EXPECT_NEAR(motion.at(5.5).v[0], 0.5, 1e-12);
}

TEST_P(IntegrateAndFire, FiresAlikeInAnyPeriods) {
  Plant plant(neuron(), {0, {0.0}, {0.0}});
  std::size_t fired = 0;
  for (int i = 1; i <= 55; ++i) plant.advance(0.1 * i, [&](const Switch&) { ++fired; });
  EXPECT_EQ(fired, 5u);
  EXPECT_NEAR(plant.state().v[0], 0.5, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(InItsDirectionOrEither, IntegrateAndFire,
                         ::testing::Values(Crossing::rising, Crossing::either));

TEST(EventAtTheStart, OccursIfTheMotionTakesItsFunctionOverZero) {
  const auto position = [](double, const Vector& q, const Vector&) { return q[0]; };
  System<1> system = particle();
  system.event("rises", position, Crossing::rising).event("falls", position, Crossing::falling);
  const std::vector<Switch> switches = solve(system, {0, {0.0}, {1.0}}, 1).switches();
  ASSERT_EQ(switches.size(), 1u);
  EXPECT_EQ(switches[0].time, 0);
  EXPECT_EQ(switches[0].events, std::vector<std::size_t>{0});
}

TEST(EventAtTheStart, AppliesItsReset) {
  System<1> ball = particle();
  ball.event(
      "wall", [](double, const Vector& q, const Vector&) { return q[0]; }, Crossing::falling,
      [](double, const Vector&, const Vector& v) { return Vector{-v[0] / 2}; });
  EXPECT_NEAR(solve(ball, {0, {0.0}, {-1.0}}, 1).at(1).q[0], 0.5, 1e-12);
  EXPECT_TRUE(solve(ball, {0, {0.0}, {1.0}}, 1).switches().empty()) << "it leaves the wall";
}

TEST(EventAtTheStart, DoesNotOccurIfItsFunctionOnlyTouchesZero) {
  System<1> ball = particle(1);
  ball.event("touches", [](double, const Vector& q, const Vector&) { return q[0]; });
  EXPECT_TRUE(solve(ball, {0, {0.0}, {0.0}}, 1).switches().empty());
}

TEST(EventsAtOneInstant, OccurOnceEach) {
  for (const double duration : {1.0, 2.0, 5.0, 10.0}) {
    for (const double instant : {0.1, 0.25, 0.5, 0.6, 0.75, 0.9}) {
      for (const double speed : {1.0, 2.0, 0.5, 0.3}) {
        System<1> system = particle();
        system.event("clock", [=](double t, const Vector&, const Vector&) { return t - instant; });
        system.event("place", [=](double, const Vector& q, const Vector&) { return q[0] - instant * speed; });
        const Solution motion = solve(system, {0, {0.0}, {speed}}, duration);
        EXPECT_EQ(events(motion.switches(), 0), 1u) << duration << " " << instant << " " << speed;
        EXPECT_EQ(events(motion.switches(), 1), 1u) << duration << " " << instant << " " << speed;
      }
    }
  }
}

TEST(EventsAtOneInstant, ApplyTheirResetsInTheOrderOfTheModel) {
  System<1> system = particle();
  const auto clock = [](double t, const Vector&, const Vector&) { return t - 0.6; };
  system.event("kick", clock, Crossing::either,
               [](double, const Vector&, const Vector& v) { return Vector{v[0] + 1}; });
  system.event(
      "double", [](double t, const Vector&, const Vector&) { return 2 * (t - 0.6); }, Crossing::either,
      [](double, const Vector&, const Vector& v) { return Vector{2 * v[0]}; });
  const Solution motion = solve(system, {0, {0.0}, {1.0}}, 1);
  EXPECT_EQ(motion.at(1).v[0], 4);
}

TEST(EventAtTheBeginOfAConstraint, OccursOnce) {
  for (const double duration : {1.0, 2.0, 5.0, 10.0}) {
    for (const double instant : {0.1, 0.25, 0.5, 0.6, 0.75, 0.9}) {
      System<1> system = particle();
      system.event("clock", [=](double t, const Vector&, const Vector&) { return t - instant; });
      system.constrain(
          "driven", [](auto, const auto&, const auto& v) { return v[0] - 2; }, from(instant));
      const Solution motion = solve(system, {0, {0.0}, {1.0}}, duration);
      EXPECT_EQ(events(motion.switches(), 0), 1u) << duration << " " << instant;
      EXPECT_NEAR(motion.at(duration).v[0], 2, 1e-14);
    }
  }
}

TEST(EventAtTheEnd, Occurs) {
  System<1> system = particle();
  system.event("place", [](double, const Vector& q, const Vector&) { return q[0] - 1; });
  EXPECT_EQ(solve(system, {0, {0.0}, {1.0}}, 1).switches().size(), 1u);
  EXPECT_EQ(solve(system, {0, {0.0}, {0.5}}, 2).switches().size(), 1u);
  EXPECT_EQ(solve(system, {0, {0.0}, {0.3}}, 1 / 0.3).switches().size(), 1u);
}

TEST(EventAtATick, OccursOnceWithAnInputAtEachTick) {
  const auto pushed = [](const Vector& input) {
    System<1> system = particle(input[0]);
    system.event("place", [](double, const Vector& q, const Vector&) { return q[0] - 1; });
    return Model(system);
  };
  for (const int ticks : {1, 2, 3, 4, 5, 7, 8, 10, 16, 20, 32, 64}) {
    Plant plant(pushed, {0.0}, {0, {0.0}, {1.0}});
    std::size_t occurred = 0;
    for (int i = 1; i <= 2 * ticks; ++i) {
      plant.advance(double(i) / ticks, [&](const Switch& s) { occurred += s.events.size(); });
      plant.set_input({0.0});
    }
    EXPECT_EQ(occurred, 1u) << ticks;
  }
}

// An impact changes a function of the velocities, too: the way to which it leads back counts.
TEST(EventOfVelocities, OccursAgainAfterAnImpactHasTakenItsFunctionBack) {
  System<1> ball({"z"}, [](auto, const auto& q, const auto& v) { return v[0] * v[0] / 2 - 10 * q[0]; });
  ball.unilateral(
      "floor", [](const auto&, const auto& q) { return q[0]; }, 1);
  for (const Crossing crossing : {Crossing::rising, Crossing::falling, Crossing::either}) {
    System<1> watched = ball;
    watched.event(
        "fast", [](double, const Vector&, const Vector& v) { return -v[0] - 1; }, crossing);
    const Solution motion = solve(watched, {0, {5.0}, {0.0}}, 10.5);  // impacts at 1, 3, 5, 7 and 9 s
    ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
    std::vector<double> times;
    for (const Switch& s : motion.switches()) {
      if (!s.events.empty()) times.push_back(s.time);
    }
    std::vector<double> expected;
    for (int i = 0; i < 5; ++i) {
      if (crossing != Crossing::falling) expected.push_back(2 * i + 0.1);  // 1 m/s after the highest point
      if (crossing != Crossing::rising) expected.push_back(2 * i + 1);     // at the impact
    }
    if (crossing != Crossing::falling) expected.push_back(10.1);
    ASSERT_EQ(times.size(), expected.size());
    for (std::size_t i = 0; i < times.size(); ++i) EXPECT_NEAR(times[i], expected[i], 1e-8);
  }
}

TEST(EventOfAConservedQuantity, DoesNotOccurByRoundOff) {
  System<1> oscillator{{"x"},
                       [](auto, const auto& q, const auto& v) { return (v[0] * v[0] - q[0] * q[0]) / 2; }};
  oscillator.event("energy", [](double, const Vector& q, const Vector& v) {
    return (v[0] * v[0] + q[0] * q[0]) / 2 - 0.5;
  });
  EXPECT_TRUE(solve(oscillator, {0, {1.0}, {0.0}}, 100).switches().empty());
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::event_instants_test
