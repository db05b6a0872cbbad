#include "hybrid_sphere/mechanics/solve.hpp"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>

#include "core/mechanics/particle.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::guard_test {
namespace {

using testing::accurate, testing::level, testing::particle, testing::vector;

/// Of uniform motions of speeds up to 1, which the steps follow exactly: roundings of x, of t and of a root,
/// as large as they are.
constexpr double roundings(double size) { return 8 * size * DBL_EPSILON; }

// A guard is an event, a stage an interval: [..) on the side that the motion enters.
TEST(Guard, IsCrossedWhereItsRootIs) {
  System<2> system = particle(1);
  system.constrain("level", level, while_positive([](auto, const auto& q) { return -1 - q[1]; }));
  const Solution solution = solve(system, {0, vector({0, 0}), vector({3, 0})}, 2);
  ASSERT_EQ(solution.switches().size(), 1u);
  // y = -t^2/2 is -1 at sqrt(2); the steps follow it exactly, at a speed above 1.
  const double rounding = static_cast<double>(solution.steps()) * DBL_EPSILON;
  EXPECT_NEAR(solution.switches()[0].time, std::sqrt(2.0), rounding);
  EXPECT_NEAR(solution.at(2).q[1], -1, rounding);
}

TEST(Guard, IsAppliedAndReleasedAsOftenAsItChangesItsSign) {
  System<2> system = particle();
  system.constrain("level", level, while_positive([](auto, const auto& q) {
                     using std::sin;
                     return sin(q[0]);
                   }));
  const Solution solution = solve(system, {0, vector({-0.5, 0}), vector({1, 1})}, 20);
  // x = t - 1/2 meets 0, pi, ..., 6 pi before t = 20.
  ASSERT_EQ(solution.switches().size(), 7u);
  for (const Switch& change : solution.switches()) {
    const double expected = 0.5 + M_PI * static_cast<double>(change.index);
    EXPECT_NEAR(change.time, expected, roundings(20));
    EXPECT_EQ(change.applied.size(), change.index % 2 == 0 ? 1u : 0u);
  }
  const ConstraintReport report = solution.constraints()[0];
  EXPECT_EQ(report.applied, 4u);
  EXPECT_NEAR(report.held, 3 * M_PI + 20 - 0.5 - 6 * M_PI, 8 * roundings(20));  // from 7 instants
}

// A free motion alone allows steps over many periods of this guard.
TEST(Guard, ThatChangesFasterThanTheMotionIsFollowed) {
  System<2> system = particle();
  system.constrain("level", level, while_positive([](auto, const auto& q) {
                     using std::sin;
                     return sin(40 * q[0]);
                   }));
  const Solution solution = solve(system, {0, vector({-0.01, 0}), vector({1, 1})}, 10, accurate(1e-3));
  // x = t - 0.01 meets n pi/40 below 9.99, n from 0.
  ASSERT_EQ(solution.switches().size(), static_cast<std::size_t>(9.99 * 40 / M_PI) + 1);
  // Each segment rounds its x and t.
  const auto segments = static_cast<double>(solution.switches().size());
  EXPECT_NEAR(solution.switches().back().time,
              0.01 + M_PI / 40 * static_cast<double>(solution.switches().back().index),
              segments * roundings(10));
}

// A polynomial of the time, which the steps themselves follow exactly, however long they are.
TEST(Guard, ThatIsAPolynomialWithCloseRootsIsFollowed) {
  const std::vector<double> edges = {-1, -0.5, 0, 0.3, 0.31, 1};
  for (const double accuracy : {1e-2, 1e-6, 1e-12}) {
    System<2> system = particle();
    system.constrain("level", level, while_positive([=](auto, const auto& q) {
                       auto product = q[0] - edges[0];
                       for (std::size_t i = 1; i < edges.size(); ++i) product *= q[0] - edges[i];
                       return product;
                     }));
    const Solution solution = solve(system, {0, vector({-0.75, 0}), vector({1, 1})}, 4, accurate(accuracy));
    ASSERT_EQ(solution.switches().size(), 5u) << "accuracy " << accuracy;
    for (const Switch& change : solution.switches()) {
      // Where two roots are 0.01 apart, the factors of the others are 0.2 at least; a product of 6 rounds.
      EXPECT_NEAR(change.time, edges[change.index + 1] + 0.75, 6 * roundings(1));
    }
  }
}

// The rest of the motion is then too short for ARKODE.
TEST(Guard, MayChangeJustBeforeTheEnd) {
  for (const double rest : {1e-3, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-12, 1e-14}) {
    System<2> system = particle();
    system.constrain("level", level,
                     while_positive([](auto, const auto& q) { return (q[0] - 1) * (3 - q[0]); }));
    const Solution end = solve(system, {0, vector({0, 0}), vector({1, 1})}, 1 + rest);
    EXPECT_EQ(end.status().stop, Stop::reached_end) << rest << ": " << end.status().message;
    EXPECT_EQ(end.switches().size(), 1u) << rest;
    system.constrain(
        "slow", [](auto, const auto&, const auto& v) { return v[0] - 0.5; }, from(1 + rest));
    const Solution another = solve(system, {0, vector({0, 0}), vector({1, 1})}, 2);
    EXPECT_EQ(another.status().stop, Stop::reached_end) << rest << ": " << another.status().message;
    EXPECT_EQ(another.switches().size(), 2u) << rest;
  }
}

// One step may pass over both roots of a guard: only its extremum shows them.
TEST(Guard, OfAThinStripIsNotSteppedOver) {
  for (const double width : {1e-3, 1e-6, 1e-9}) {
    System<2> system = particle();
    system.constrain("level", level, while_positive([=](auto, const auto& q) {
                       return width * width / 4 - (q[0] - 5) * (q[0] - 5);
                     }));
    const Solution solution = solve(system, {0, vector({0, 0}), vector({1, 1})}, 10);
    ASSERT_EQ(solution.switches().size(), 2u) << "width " << width;
    EXPECT_NEAR(solution.switches()[0].time, 5 - width / 2, roundings(10));
    EXPECT_NEAR(solution.switches()[1].time, 5 + width / 2, roundings(10));
  }
}

TEST(Guard, ThatIsTouchedFromOutsideAppliesNothing) {
  System<2> system = particle();
  system.constrain("level", level,
                   while_positive([](auto, const auto& q) { return -(q[0] - 5) * (q[0] - 5); }));
  const Solution solution = solve(system, {0, vector({0, 0}), vector({1, 1})}, 10);
  EXPECT_EQ(solution.status().stop, Stop::reached_end);
  EXPECT_TRUE(solution.switches().empty());
  EXPECT_NEAR(solution.at(10).q[1], 10, roundings(10));
}

TEST(Guard, ThatIsZeroAlongTheMotionLeavesItAsItWas) {
  System<2> system = particle();
  system.constrain("level", level, while_positive([](auto, const auto& q) { return q[1]; }));
  const Solution solution = solve(system, {0, vector({0, 0}), vector({1, 0})}, 10);
  EXPECT_EQ(solution.status().stop, Stop::reached_end);
  EXPECT_TRUE(solution.switches().empty());
}

TEST(Guard, HoldsAtOnceWhenTheMotionEntersFromItsEdge) {
  System<2> system = particle();
  system.constrain("level", level, while_positive([](auto, const auto& q) { return q[0]; }));
  const Solution inward = solve(system, {0, vector({0, 0}), vector({1, 1})}, 1);
  ASSERT_EQ(inward.switches().size(), 1u);
  EXPECT_EQ(inward.switches()[0].time, 0);
  const Solution outward = solve(system, {0, vector({0, 0}), vector({-1, 1})}, 1);
  EXPECT_TRUE(outward.switches().empty());
}

// At rest on the edge nothing but the force tells on which side the motion goes.
TEST(Guard, LooksAheadWhereTheVelocityVanishes) {
  for (const double gravity : {-1.0, 1.0}) {
    System<2> system = particle(gravity);
    system.constrain(
        "upright", [](auto, const auto&, const auto& v) { return v[0]; },
        while_positive([](auto, const auto& q) { return q[1]; }));
    const Solution solution = solve(system, {0, vector({0, 0}), vector({1, 0})}, 1);
    EXPECT_EQ(solution.switches().size(), gravity < 0 ? 1u : 0u) << "gravity " << gravity;
  }
}

// x' = -1/2 after the impulse: applied and released in one instant, then free.
TEST(Guard, ThatThrowsTheMotionBackIsReleasedAtTheSameInstant) {
  System<2> system = particle();
  system.constrain(
      "belt", [](auto, const auto&, const auto& v) { return v[0] + 0.5; },
      while_positive([](auto, const auto& q) { return q[0]; }));
  const Solution solution = solve(system, {0, vector({-1, 0}), vector({1, 0})}, 5);
  ASSERT_EQ(solution.switches().size(), 2u);
  EXPECT_NEAR(solution.switches()[0].time, 1, roundings(1));
  EXPECT_EQ(solution.switches()[0].time, solution.switches()[1].time);
  EXPECT_NEAR(solution.switches()[0].v_after[0], -0.5, DBL_EPSILON);
  EXPECT_EQ(solution.switches()[1].released, ActiveSet{0});
  EXPECT_NEAR(solution.at(5).q[0], -2, roundings(5));
}

TEST(Guard, StopsExactlyOnTheEdgeWhereTheImpulseTakesTheVelocity) {
  System<2> system = particle();
  system.constrain(
      "stop", [](auto, const auto&, const auto& v) { return v[0]; },
      while_positive([](auto, const auto& q) { return q[0]; }));
  const Solution solution = solve(system, {0, vector({-1, 0}), vector({1, 1})}, 5);
  ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
  ASSERT_EQ(solution.switches().size(), 1u);
  EXPECT_NEAR(solution.at(5).q[0], 0, roundings(1));
  EXPECT_EQ(solution.at(5).stage, 3);
}

TEST(Guards, ThatThrowTheMotionAtEachOtherAreALivelock) {
  System<2> system = particle();
  system.constrain(
      "right", [](auto, const auto&, const auto& v) { return v[0] + 1; },
      while_positive([](auto, const auto& q) { return q[0]; }));
  system.constrain(
      "left", [](auto, const auto&, const auto& v) { return v[0] - 1; },
      while_positive([](auto, const auto& q) { return -q[0]; }));
  const Solution solution = solve(system, {0, vector({-1, 0}), vector({1, 0})}, 5);
  EXPECT_EQ(solution.status().stop, Stop::livelock) << solution.status().message;
  EXPECT_NEAR(solution.status().time, 1, roundings(1));
  EXPECT_NE(solution.status().message.find("right"), std::string::npos) << solution.status().message;
  EXPECT_NE(solution.status().message.find("left"), std::string::npos) << solution.status().message;
}

TEST(Guards, ThatChangeTogetherAreOneSwitch) {
  System<2> system = particle();
  const auto side = [](auto, const auto& q) { return 3 * q[0]; };
  system.constrain("level", level, while_positive(side));
  system.constrain(
      "slow", [](auto, const auto&, const auto& v) { return v[0] - 0.5; },
      while_positive([](auto, const auto& q) { return q[0] / 7; }));
  const Solution solution = solve(system, {0, vector({-1, 0}), vector({1, 1})}, 5);
  ASSERT_EQ(solution.switches().size(), 1u);
  EXPECT_EQ(solution.switches()[0].applied, (ActiveSet{0, 1}));
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::guard_test
