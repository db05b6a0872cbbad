// Rods that are thrown on the ground: two contacts, their frictions and bounces at once. Plates that fly
// against a wall: two contacts that strike in turn.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/mechanics/contact_systems.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"
#include "support/case_count.hpp"

namespace hybrid_sphere::mechanics::contact_property_test {
namespace {

struct Throw {
  double mu;
  double restitution;
  Initial start;
};

Throw random_throw(std::mt19937& random) {
  const auto within = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const double angle = within(-1.2, 1.2);
  const double height = std::sin(std::abs(angle)) + within(0.01, 1);
  return {within(0, 0.6),
          random() % 2 == 0 ? 0 : within(0, 0.7),
          {0, {0, height, angle}, {within(-3, 3), within(-2, 1), within(-3, 3)}}};
}

/// The ends stay above the ground, are pressed and not pulled, and friction stays within its cone.
void expect_lawful(const Solution& motion, double mu) {
  for (int i = 0; i <= 200; ++i) {
    const State state = motion.at(motion.end() * i / 200);
    for (const double side : {-1.0, 1.0}) {
      const Index normal = side < 0 ? 0 : 2;
      const double gap = state.q[1] + side * std::sin(state.q[2]);
      EXPECT_GT(gap, -1e-9) << state.time;
      EXPECT_GT(state.multipliers[normal], -1e-7) << state.time;
      EXPECT_LE(std::abs(state.multipliers[normal + 1]), mu * state.multipliers[normal] + 1e-7) << state.time;
      const bool holds = std::count(state.active.begin(), state.active.end(), std::size_t(normal)) > 0;
      EXPECT_LE(holds ? std::abs(gap) : 0, 1e-12) << state.time;
    }
  }
}

void expect_lawful(const Switch& change, double mu) {
  EXPECT_LE(change.energy_after, change.energy_before + 1e-9) << change.time;
  for (const Index normal : {0, 2}) {
    EXPECT_GE(change.multipliers[normal], 0) << change.time;
    EXPECT_LE(std::abs(change.multipliers[normal + 1]), mu * change.multipliers[normal] + 1e-9)
        << change.time;
  }
}

TEST(RodProperty, ContactsAreComplementaryAndDissipate) {
  std::mt19937 random(1);
  Options options;
  options.max_switches = 2000;
  const int cases = hybrid_sphere::testing::case_count(20);
  for (int i = 0; i < cases; ++i) {
    const Throw thrown = random_throw(random);
    SCOPED_TRACE(::testing::Message()
                 << "throw " << i << ", mu " << thrown.mu << ", restitution " << thrown.restitution);
    const Solution motion = solve(testing::rod(thrown.mu, thrown.restitution), thrown.start, 3, options);
    ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
    ASSERT_FALSE(motion.switches().empty());
    expect_lawful(motion, thrown.mu);
    for (const Switch& change : motion.switches()) expect_lawful(change, thrown.mu);
  }
}

/// Without weight, and with corners above and below its centre. @param half  its height
System<3> plate(double half) {
  System<3> system({"x", "y", "angle"}, [](const auto&, const auto&, const auto& v) {
    return (v[0] * v[0] + v[1] * v[1] + 0.1 * v[2] * v[2]) / 2;
  });
  for (const double side : {-1.0, 1.0}) {
    system.unilateral(side < 0 ? "low" : "high", [half, side](const auto&, const auto& q) {
      using std::sin;
      return q[0] + side * half * sin(q[2]);
    });
  }
  return system;
}

// The corners of plates that are not slender strike in turn, ever faster, until the plate is at rest on the
// wall.
TEST(PlateProperty, ComesToItsEndHoweverItsCornersStrike) {
  std::mt19937 random(1);
  Options options;
  options.max_switches = 1000;
  const int cases = hybrid_sphere::testing::case_count(8);
  for (const double half : {0.1, 0.2, 0.5, 2.0}) {
    for (int i = 0; i < cases; ++i) {
      const auto within = [&](double size) {
        return std::uniform_real_distribution<double>(-size, size)(random);
      };
      const Initial start{0, {1, 0, within(0.3)}, {-1, 0, within(0.5)}};
      SCOPED_TRACE(::testing::Message() << "half height " << half << ", plate " << i);
      const Solution motion = solve(plate(half), start, 5, options);
      ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
      EXPECT_FALSE(motion.switches().empty());
      for (const Switch& change : motion.switches()) {
        EXPECT_LE(change.energy_after, change.energy_before * (1 + 1e-12)) << change.time;
        EXPECT_GE(change.multipliers.minCoeff(), 0) << change.time;
      }
      for (int k = 0; k <= 100; ++k) {
        const State state = motion.at(motion.end() * k / 100);
        for (const double side : {-1.0, 1.0}) {
          EXPECT_GT(state.q[0] + side * half * std::sin(state.q[2]), -1e-14) << state.time;
        }
      }
    }
  }
}

TEST(PlateProperty, IsAtRestAfterOneImpulseWhereItMeetsTheWallFlat) {
  const Solution motion = solve(plate(0.5), {0, {1, 0, 0}, {-1, 0, 0}}, 3);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  ASSERT_EQ(motion.switches().size(), 1u);
  EXPECT_NEAR(motion.switches()[0].time, 1, 1e-15);
  EXPECT_NEAR(motion.switches()[0].multipliers[0], 0.5, 1e-15);
  EXPECT_NEAR(motion.switches()[0].multipliers[1], 0.5, 1e-15);
  EXPECT_EQ(motion.at(3).v, Vector(Vector::Zero(3)));
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::contact_property_test
