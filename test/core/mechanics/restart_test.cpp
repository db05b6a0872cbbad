// Motions that their own constraint keeps on its guard's edge, begun anew from their states: as a loop around
// a controller does that has nothing but time, coordinates and velocities.
#include <gtest/gtest.h>

#include <cmath>

#include "core/mechanics/particle.hpp"

namespace hybrid_sphere::mechanics::restart_test {
namespace {

/// A coin that falls flat on rough ground and rolls; z, and its angles, are those of its centre.
Model coin() {
  constexpr double m = 0.01, r = 0.02, g = 9.81, across = m * r * r / 4, along = m * r * r / 2;
  System<6> system({"x", "y", "z", "yaw", "tilt", "spin"}, [=](auto, const auto& q, const auto& v) {
    using std::cos, std::sin;
    auto w3 = v[5] + v[3] * cos(q[4]);
    auto w2 = v[3] * sin(q[4]);
    return m / 2 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) + across / 2 * (v[4] * v[4] + w2 * w2) +
           along / 2 * w3 * w3 - m * g * q[2];
  });
  const auto contact = [=](auto, const auto& q, const auto& v) {
    using std::cos, std::sin;
    using T = std::decay_t<decltype(q[0] + v[0])>;
    const T c = cos(q[3]), s = sin(q[3]), C = cos(q[4]), S = sin(q[4]);
    const T u1 = r * (v[5] + v[3] * C);
    const T u3 = -r * v[4];
    return Eigen::Matrix<T, 3, 1>(v[0] + u1 * c + u3 * s * S, v[1] + u1 * s - u3 * c * S, v[2] + u3 * C);
  };
  system.constrain("landed", contact, while_positive([=](auto, const auto& q) {
                     using std::sin;
                     return r * sin(q[4]) - q[2];
                   }));
  return system;
}

void expect_one_landing(const Model& model, const Initial& start, double duration, double period) {
  const Solution whole = solve(model, start, duration);
  ASSERT_EQ(whole.switches().size(), 1u);
  const double landing = whole.switches()[0].time;
  Initial now = start;
  std::size_t switches = 0;
  while (now.time < start.time + duration - 1e-9) {
    const Solution part = solve(model, now, period);
    ASSERT_EQ(part.status().stop, Stop::reached_end) << part.status().message;
    switches += part.switches().size();
    if (now.time > landing + 1e-9) {
      EXPECT_EQ(part.at(part.begin()).active.size(), 1u) << "t = " << now.time;
    }
    const State end = part.at(part.end());
    now = {end.time, end.q, end.v};
  }
  EXPECT_EQ(switches, 1u) << "period " << period;
}

TEST(Restart, OnAHillGoesOnSliding) {
  for (const double period : {0.1, 0.01, 0.001})
    expect_one_landing(testing::on_a_hill(), {0, {0, 1}, {2, 0}}, 2, period);
}

TEST(Restart, OfACoinGoesOnRolling) {
  for (const double period : {0.05, 0.01, 0.001}) {
    expect_one_landing(coin(), {0, {0, 0, 0.05, 0, 1.2, 0}, {0.1, -0.3, 0.1, 2, 0.5, 20}}, 0.6, period);
  }
}

TEST(Restart, AtRestOnTheGroundStaysThere) {
  const Model model =
      System<2>(testing::particle(9.81))
          .constrain("ground", testing::level, while_positive([](auto, const auto& q) { return -q[1]; }));
  const Solution solution = solve(model, {0, {1, 0}, {0, 0}}, 1);
  EXPECT_TRUE(solution.switches().empty());
  EXPECT_EQ(solution.at(0).active, ActiveSet{0});
  EXPECT_EQ(solution.at(1).q[1], 0);
}

// The velocities lead away: nothing holds the ball that is thrown up.
TEST(Restart, OfABallThatIsThrownUpIsFree) {
  const Model model =
      System<2>(testing::particle(9.81))
          .constrain("ground", testing::level, while_positive([](auto, const auto& q) { return -q[1]; }));
  const Solution solution = solve(model, {0, {0, 0}, {0, 1}}, 1);
  ASSERT_EQ(solution.switches().size(), 1u);
  EXPECT_NEAR(solution.switches()[0].time, 2 / 9.81, 1e-14);
}

// Friction that jumps to and fro at v = 0 gives no motion at all.
TEST(DryFriction, AsAForceEndsAtRestWithItsName) {
  System<2> system(
      {"x", "y"}, [](auto, const auto&, const auto& v) { return v.squaredNorm() / 2; },
      [](double, const auto&, const auto& v) -> Eigen::Vector2d { return -v / v.norm(); });
  const Solution solution = solve(system, {0, {0, 0}, {1, 0.5}}, 3);
  EXPECT_EQ(solution.status().stop, Stop::no_step);
  EXPECT_NE(solution.status().message.find("dry friction"), std::string::npos) << solution.status().message;
  EXPECT_LE(solution.steps(), 10'000u);
  EXPECT_NEAR(solution.end(), std::sqrt(1.25), 1e-8);
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::restart_test
