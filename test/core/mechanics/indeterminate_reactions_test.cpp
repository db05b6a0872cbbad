// A ladder on rough ground against a rough wall: four reactions, of which its rest determines three. Planks
// on several supports, of which it determines two.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::indeterminate_reactions_test {
namespace {

constexpr double g = 9.81;
constexpr double person = 80;  // [N], beside a ladder of 1 kg
const double lean = 0.8;       // [rad] from the ground

/// Of length 2, and with somebody who climbs it at this speed. q: its centre, and its angle from the ground.
System<3> ladder(double mu, double speed) {
  System<3> system(
      {"x", "z", "angle"},
      [](const auto&, const auto& q, const auto& v) {
        return (v[0] * v[0] + v[1] * v[1] + v[2] * v[2] / 3.0) / 2 - g * q[1];
      },
      [speed](const auto& t, const auto& q, const auto&) {
        return Eigen::Vector3d(0, -person, -person * (speed * t - 1) * std::cos(q[2]));
      });
  system.unilateral("floor", [](const auto&, const auto& q) {
    using std::sin;
    return q[1] - sin(q[2]);
  });
  system.friction(
      "foot",
      [](const auto&, const auto& q, const auto& v) {
        using std::sin;
        return v[0] - sin(q[2]) * v[2];
      },
      mu, "floor");
  system.unilateral("wall", [](const auto&, const auto& q) {
    using std::cos;
    return q[0] - cos(q[2]);
  });
  system.friction(
      "head",
      [](const auto&, const auto& q, const auto& v) {
        using std::cos;
        return v[1] + cos(q[2]) * v[2];
      },
      mu, "wall");
  return system;
}

const Initial standing{0, {std::cos(lean), std::sin(lean), lean}, {0, 0, 0}};

/// How far up the last grip reaches: both ends are at their limits, N_f (1 + mu^2) is the whole weight and
///   (g + W s) cos a = mu N_f (sin a + mu cos a).
double highest(double mu) {
  const double foot = (person + g) / (1 + mu * mu);
  return (mu * foot * (std::tan(lean) + mu) * 2 - g) / person;
}

void expect_within_limits(const State& state, double mu) {
  const Vector& lambda = state.multipliers;
  const double tolerance = 1e-9 * (person + g);
  for (const Index contact : {0, 2}) {
    EXPECT_GE(lambda[contact], -tolerance) << state.time;
    EXPECT_LE(std::abs(lambda[contact + 1]), mu * lambda[contact] + tolerance) << state.time;
  }
}

TEST(Ladder, StandsWhileSomeReactionsHoldIt) {
  for (const double mu : {0.45, 0.6, 0.8, 1.0}) {
    const Solution motion = solve(ladder(mu, 0), standing, 3);
    ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
    EXPECT_TRUE(motion.switches().empty()) << mu;
    const State end = motion.at(3);
    expect_within_limits(end, mu);
    EXPECT_LE((end.q - standing.q).lpNorm<Eigen::Infinity>(), 1e-14) << mu;
  }
}

class LadderAt : public ::testing::TestWithParam<double> {};

TEST_P(LadderAt, SlipsWhereTheLastGripIsLost) {
  constexpr double speed = 0.1;
  Options options;
  options.accuracy = GetParam();
  for (const double mu : {0.35, 0.45, 0.55}) {
    const double slips = highest(mu) / speed;
    const Solution motion = solve(ladder(mu, speed), standing, slips + 0.3, options);
    ASSERT_FALSE(motion.switches().empty()) << mu << ": " << motion.status().message;
    const Switch& first = motion.switches().front();
    EXPECT_NEAR(first.time, slips, std::max(1e-11, options.accuracy) * slips) << mu;
    ASSERT_EQ(motion.status().stop, Stop::reached_end) << mu << ": " << motion.status().message;
    for (int i = 0; i < 50; ++i) expect_within_limits(motion.at(motion.end() * i / 50), mu);
    EXPECT_LT(motion.at(motion.end()).q[2], lean - 1e-3) << mu;
    EXPECT_LE(motion.switches().size(), 3u) << mu;
  }
}

INSTANTIATE_TEST_SUITE_P(Accuracies, LadderAt, ::testing::Values(1e-6, 1e-9, 1e-12));

/// A plank of unit mass whose load acts at this place, on supports along it.
System<2> plank(const std::vector<double>& supports, double load_at) {
  System<2> system(
      {"z", "angle"}, [](const auto&, const auto&, const auto& v) { return (v[0] * v[0] + v[1] * v[1]) / 2; },
      [load_at](const auto&, const auto&, const auto&) { return Eigen::Vector2d(-g, -g * load_at); });
  for (std::size_t i = 0; i < supports.size(); ++i) {
    system.unilateral("support " + std::to_string(i), [x = supports[i]](const auto&, const auto& q) {
      using std::sin;
      return q[0] + x * sin(q[1]);
    });
  }
  return system;
}

// Multipliers of least norm are linear along the plank: beyond a third of its half they would pull.
TEST(Plank, RestsWhereverItsLoadIsBetweenItsSupports) {
  for (const std::vector<double>& supports :
       {std::vector<double>{-1, 0, 1}, {-1, -0.4, 0.4, 1}, {-1, -0.5, 0, 0.5, 1}}) {
    for (const double load_at : {0.0, 0.3, -0.6, 0.9, -0.99}) {
      SCOPED_TRACE(::testing::Message() << supports.size() << " supports, load at " << load_at);
      const Solution motion = solve(plank(supports, load_at), {0, {0, 0}, {0, 0}}, 2);
      ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
      EXPECT_TRUE(motion.switches().empty());
      const State end = motion.at(2);
      EXPECT_LE(end.q.lpNorm<Eigen::Infinity>(), 1e-15);
      double moment = 0;
      for (std::size_t i = 0; i < supports.size(); ++i) moment += supports[i] * end.multipliers[Index(i)];
      EXPECT_GE(end.multipliers.minCoeff(), 0) << end.multipliers.transpose();
      EXPECT_NEAR(end.multipliers.sum(), g, 1e-12);
      EXPECT_NEAR(moment, g * load_at, 1e-12);
    }
  }
}

TEST(Plank, TipsWhereItsLoadIsBeyondItsSupports) {
  const Solution motion = solve(plank({-1, 0, 1}, 1.1), {0, {0, 0}, {0, 0}}, 0.1);
  EXPECT_LT(motion.at(0.1).q[1], -1e-4);
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::indeterminate_reactions_test
