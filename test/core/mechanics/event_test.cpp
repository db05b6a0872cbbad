// Events of the user's own: reported, and with resets.
#include "hybrid_sphere/mechanics/event.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "hybrid_sphere/mechanics/plant.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::event_test {
namespace {

System<1> oscillator() {
  return {{"x"}, [](auto, const auto& q, const auto& v) { return (v[0] * v[0] - q[0] * q[0]) / 2; }};
}

System<1> falling(double gravity) {
  return {{"z"}, [gravity](auto, const auto& q, const auto& v) { return v[0] * v[0] / 2 - gravity * q[0]; }};
}

class Event : public ::testing::TestWithParam<double> {
 protected:
  Options options() const {
    Options options;
    options.accuracy = GetParam();
    return options;
  }
};

// x = cos t, v = -sin t.
TEST_P(Event, IsReportedInItsDirections) {
  System<1> system = oscillator();
  const auto position = [](double, const Vector& q, const Vector&) { return q[0]; };
  const auto velocity = [](double, const Vector&, const Vector& v) { return v[0]; };
  system.event("x falls", position, Crossing::falling);
  system.event("x rises", position, Crossing::rising);
  system.event("turns", velocity);
  const Solution motion = solve(system, {0, {1.0}, {0.0}}, 10, options());
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  // It begins where it turns.
  const std::vector<std::vector<std::size_t>> expected{{2}, {0}, {2}, {1}, {2}, {0}, {2}};
  ASSERT_EQ(motion.switches().size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const Switch& event = motion.switches()[i];
    EXPECT_EQ(event.events, expected[i]) << i;
    EXPECT_NEAR(event.time, M_PI / 2 * double(i), 4 * GetParam()) << i;
    EXPECT_EQ(event.v_after, event.v_before) << i;
    EXPECT_EQ(event.index, i);
  }
  EXPECT_NEAR(motion.at(10).q[0], std::cos(10), GetParam());
}

// A ball whose bounce is the user's own: it ends where its bounces accumulate.
TEST_P(Event, WithAResetIsABounce) {
  constexpr double gravity = 9.81, e = 0.5;
  System<1> ball = falling(gravity);
  ball.event(
      "bounce", [](double, const Vector& q, const Vector&) { return q[0]; }, Crossing::falling,
      [](double, const Vector&, const Vector& v) { return Vector{-e * v[0]}; });
  const Solution motion = solve(ball, {0, {1.0}, {0.0}}, 3, options());
  const double first = std::sqrt(2 / gravity);
  double time = first;
  double speed = gravity * first;
  for (std::size_t i = 0; i < 12; ++i) {
    const Switch& bounce = motion.switches().at(i);
    EXPECT_NEAR(bounce.time, time, 2 * GetParam()) << i;
    EXPECT_NEAR(bounce.v_after[0], e * speed, 5 * GetParam()) << i;
    EXPECT_NEAR(bounce.impulse[0], (1 + e) * speed, 10 * GetParam()) << i;
    speed *= e;
    time += 2 * speed / gravity;
  }
  EXPECT_EQ(motion.status().stop, Stop::accumulation) << motion.status().message;
  EXPECT_NEAR(motion.end(), first * (1 + e) / (1 - e), 2 * GetParam() + 1e-9);
}

INSTANTIATE_TEST_SUITE_P(AtEachAccuracy, Event, ::testing::Values(1e-6, 1e-9, 1e-12));

// What an impulse takes over a function's zero has happened at that instant.
TEST(EventOfAnImpulse, IsReportedWithIt) {
  System<2> particle({"x", "y"}, [](auto, const auto&, const auto& v) { return v.squaredNorm() / 2; });
  particle.constrain(
      "rail", [](auto, const auto&, const auto& v) { return v[0] - v[1]; }, from(0.5));
  particle.event(
      "slow", [](double, const Vector&, const Vector& v) { return v[0] - 0.75; }, Crossing::falling);
  const Solution motion = solve(particle, {0, {0, 0}, {1, 0}}, 1);
  ASSERT_EQ(motion.switches().size(), 2u);
  EXPECT_EQ(motion.switches()[0].applied, ActiveSet{0});
  EXPECT_EQ(motion.switches()[1].events, (std::vector<std::size_t>{0}));
  EXPECT_EQ(motion.switches()[1].time, 0.5);
}

// A reset that leaves a constraint is put back onto it.
TEST(EventOfAConstrainedMotion, KeepsItsConstraints) {
  System<2> particle({"x", "y"}, [](auto, const auto&, const auto& v) { return v.squaredNorm() / 2; });
  particle.constrain(
      "rail", [](auto, const auto&, const auto& v) { return v[0] - v[1]; }, always());
  particle.event(
      "push", [](double, const Vector& q, const Vector&) { return q[0] - 1; }, Crossing::rising,
      [](double, const Vector&, const Vector& v) {
        return Vector{v[0] + 2, v[1]};
      });
  const Solution motion = solve(particle, {0, {0, 0}, {1, 1}}, 2);
  ASSERT_EQ(motion.switches().size(), 1u);
  EXPECT_NEAR(motion.switches()[0].v_after[0], 2, 1e-14);
  EXPECT_NEAR(motion.switches()[0].v_after[1], 2, 1e-14);
  EXPECT_NEAR(motion.at(2).q[0], 3, 1e-12);
}

TEST(EventOfAPlant, IsThatOfOneMotionInAnyPeriods) {
  System<1> ball = falling(9.81);
  ball.event(
      "bounce", [](double, const Vector& q, const Vector&) { return q[0]; }, Crossing::falling,
      [](double, const Vector&, const Vector& v) { return Vector{-0.7 * v[0]}; });
  const Initial start{0, {1.0}, {0.0}};
  std::vector<double> whole, parts;
  Plant once(ball, start);
  once.advance(2, [&](const Switch& s) { whole.push_back(s.time); });
  Plant often(ball, start);
  for (int i = 1; i <= 200; ++i) {
    if (i % 50 == 0) often.restore(often.save());
    often.advance(0.01 * i, [&](const Switch& s) { parts.push_back(s.time); });
  }
  ASSERT_EQ(parts.size(), whole.size());
  for (std::size_t i = 0; i < whole.size(); ++i) EXPECT_NEAR(parts[i], whole[i], 1e-8) << i;
}

TEST(EventOfAModel, IsRefusedWhereItMakesNoSense) {
  System<1> nothing = oscillator();
  nothing.event("nothing", {});
  EXPECT_THROW(check(nothing), std::invalid_argument);
  System<1> twice = oscillator();
  const auto position = [](double, const Vector& q, const Vector&) { return q[0]; };
  twice.event("x", position).event("x", position);
  EXPECT_THROW(check(twice), std::invalid_argument);
  System<1> wrong = oscillator();
  wrong.event("x", position, Crossing::either, [](double, const Vector&, const Vector&) {
    return Vector{1, 2};
  });
  EXPECT_THROW(solve(wrong, {0, {1.0}, {0.0}}, 10), std::invalid_argument);
  System<1> infinite = oscillator();
  infinite.event("log", [](double, const Vector& q, const Vector&) { return std::log(q[0]); });
  const Solution motion = solve(infinite, {0, {0.5}, {0.0}}, 10);
  EXPECT_EQ(motion.status().stop, Stop::not_finite);
  EXPECT_NE(motion.status().message.find("event log"), std::string::npos) << motion.status().message;
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::event_test
