// Bodies that bounce ever lower come to rest, at any restitution, place, mass and time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <tuple>

#include "core/mechanics/contact_systems.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"

namespace hybrid_sphere::mechanics::rest_after_bounces_test {
namespace {

using testing::gravity;

struct Fall {
  double restitution;
  double shelf;   // [m]
  double height;  // above it [m]
  double mass;    // [kg]
  double start;   // t [s]

  double first_speed() const { return std::sqrt(2 * gravity * height); }
  /// The time from the start to the accumulation of bounces.
  double zeno_time() const { return std::sqrt(2 * height / gravity) * (1 + restitution) / (1 - restitution); }
  /// The slowest bounce that is resolved (docs/theory.md 7.8).
  double least_speed() const {
    const double e = restitution;
    const double lost = 4 * DBL_EPSILON * shelf;  // height
    const double flight = 16 * DBL_EPSILON * (start + zeno_time());
    return std::max({std::sqrt(2 * gravity * lost / (1 - e * e)), gravity * flight / 2,
                     16 * DBL_EPSILON * first_speed()});
  }
};

Model ball_above_a_shelf(const Fall& fall) {
  const double m = fall.mass;
  System<1> ball({"z"},
                 [m](auto, const auto& q, const auto& v) { return m * (v[0] * v[0] / 2 - gravity * q[0]); });
  ball.unilateral(
      "shelf", [fall](const auto&, const auto& q) { return q[0] - fall.shelf; }, fall.restitution);
  return ball;
}

void expect_rest_from_the_accumulation_on(const Fall& fall) {
  const double duration = 1.1 * fall.zeno_time();
  const Initial initial{fall.start, {fall.shelf + fall.height}, {0.0}};
  const Solution motion = solve(ball_above_a_shelf(fall), initial, duration);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  const State end = motion.at(motion.end());
  EXPECT_EQ(end.v[0], 0);
  EXPECT_EQ(end.active, ActiveSet{0});
  EXPECT_NEAR(end.q[0], fall.shelf, 4 * DBL_EPSILON * fall.shelf);
  // All bounces after one with the speed v would last 2 v/(g (1 - e)). Round-off of positions changes the
  // height of each bounce by at most what the last one loses; by the geometric series of the bounces this
  // adds as much again. The error of the motion is relative to the whole.
  const double e = fall.restitution;
  const double rest_of_bounces = 2 * fall.least_speed() / (e * gravity * (1 - e));
  EXPECT_NEAR(motion.switches().back().time - fall.start, fall.zeno_time(),
              2 * rest_of_bounces + Options().accuracy * fall.zeno_time());
  // Each bounce keeps e of the speed, down to the slowest; round-off may halve that.
  const double bounces = std::log(2 * fall.first_speed() / fall.least_speed()) / std::log(1 / e);
  EXPECT_LE(double(motion.switches().size()), bounces + 2);
}

class RestAfterBounces : public ::testing::TestWithParam<std::tuple<double, double, double>> {};

TEST_P(RestAfterBounces, BeginsAtTheAccumulation) {
  const auto [restitution, shelf, height] = GetParam();
  for (const auto& [mass, start] : {std::pair{1.0, 0.0}, std::pair{1e-3, 1e6}}) {
    SCOPED_TRACE(::testing::Message() << "mass " << mass << ", start " << start);
    expect_rest_from_the_accumulation_on({restitution, shelf, height, mass, start});
  }
}

INSTANTIATE_TEST_SUITE_P(AtEachRestitution, RestAfterBounces,
                         ::testing::Combine(::testing::Values(0.5, 0.9, 0.97, 0.99, 0.995, 0.999),
                                            ::testing::Values(0.0, 0.2, 1.0, 3.0, 1e3),
                                            ::testing::Values(1e-3, 1.0, 100.0)));

/// The motion reaches its end, where nothing moves and all of so many contacts hold, after a bounded number
/// of switches.
void expect_rest(const Model& model, const Initial& initial, double duration, std::size_t contacts) {
  Options options;
  options.max_switches = 20000;
  const Solution motion = solve(model, initial, duration, options);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  const State end = motion.at(motion.end());
  EXPECT_EQ(end.active.size(), contacts);
  EXPECT_LE(end.v.lpNorm<Eigen::Infinity>(), 1e-14);
  for (std::size_t i = 0; i < model.constraints.size(); ++i) {
    if (!model.constraints[i].unilateral) continue;
    Vector gap;
    model.constraints[i].function->position(end.time, end.q, gap);
    EXPECT_GE(gap[0], -8 * DBL_EPSILON * end.q.cwiseAbs().sum()) << i;
  }
}

/// Balls of radius 0.05 above one another, on a floor. @param ratio  mass of each to that of the one below
template <int N>
Model column(double restitution, double floor, double ratio) {
  std::array<std::string, std::size_t(N)> names;
  for (int i = 0; i < N; ++i) names[std::size_t(i)] = "z" + std::to_string(i);
  System<N> balls(names, [ratio](auto, const auto& q, const auto& v) {
    auto lagrangian = 0 * v[0];
    double mass = 1;
    for (int i = 0; i < N; ++i, mass *= ratio) lagrangian += mass * (v[i] * v[i] / 2 - gravity * q[i]);
    return lagrangian;
  });
  for (int i = 0; i < N; ++i) {
    balls.unilateral(
        "below " + std::to_string(i),
        [i, floor](const auto&, const auto& q) { return i == 0 ? q[0] - floor : q[i] - q[i - 1] - 0.1; },
        restitution);
  }
  return balls;
}

// The upper ball meets the lower one in its flights and at rest; below resolution it stays on it.
TEST(RestAfterBouncesOfBalls, AboveOneAnother) {
  for (const double e : {0.5, 0.9, 0.97, 0.99}) {
    for (const double floor : {0.0, 0.2, 1.0}) {
      for (const double ratio : {0.1, 1.0, 10.0}) {
        SCOPED_TRACE(::testing::Message() << e << ", floor " << floor << ", ratio " << ratio);
        expect_rest(column<2>(e, floor, ratio), {0, {floor + 0.5, floor + 1}, {0, 0}}, 3 / (1 - e), 2);
      }
    }
    if (e > 0.9) continue;
    expect_rest(column<3>(e, 1, 1), {0, {1.5, 2, 3}, {0, 0, 0}}, 5 / (1 - e), 3);
  }
}

TEST(RestAfterBouncesOfABall, BetweenPlates) {
  for (const double e : {0.5, 0.9, 0.99}) {
    for (const double start : {0.0, 1e6}) {
      SCOPED_TRACE(::testing::Message() << e << ", start " << start);
      System<1> ball({"z"},
                     [](auto, const auto& q, const auto& v) { return v[0] * v[0] / 2 - gravity * q[0]; });
      ball.unilateral(
          "floor", [](const auto&, const auto& q) { return q[0] - 0.2; }, e);
      ball.unilateral(
          "ceiling", [](const auto&, const auto& q) { return 0.7 - q[0]; }, e);
      expect_rest(ball, {start, {0.5}, {8}}, 3 / (1 - e), 1);
    }
  }
}

// The floor moves with less than the acceleration of gravity: the ball comes to rest on it.
TEST(RestAfterBouncesOfABall, OnAMovingFloor) {
  constexpr double amplitude = 0.2;
  for (const double e : {0.5, 0.8}) {
    for (const double start : {0.0, 1e3}) {
      SCOPED_TRACE(::testing::Message() << e << ", start " << start);
      System<1> ball({"z"},
                     [](auto, const auto& q, const auto& v) { return v[0] * v[0] / 2 - gravity * q[0]; });
      const auto gap = [start](const auto& t, const auto& q) {
        using std::sin;
        return q[0] - 0.3 - amplitude * sin(t - start);
      };
      ball.unilateral("floor", gap, e);
      Options options;
      options.max_switches = 1000;
      const Solution motion = solve(ball, {start, {1.0}, {0.0}}, 20, options);
      ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
      const State end = motion.at(motion.end());
      EXPECT_EQ(end.active, ActiveSet{0});
      EXPECT_NEAR(end.v[0], amplitude * std::cos(20), 1e-12);
      EXPECT_NEAR(end.q[0], 0.3 + amplitude * std::sin(20), 1e-12);
    }
  }
}

// A block rocks from one edge to the other, ever faster, also with bounces of both edges.
TEST(RestAfterBouncesOfABlock, ThatRocks) {
  constexpr double half_width = 0.2, half_height = 0.5, angle = 0.2;
  for (const double e : {0.0, 0.3, 0.6}) {
    for (const double floor : {0.0, 0.2, 1.0}) {
      SCOPED_TRACE(::testing::Message() << e << ", floor " << floor);
      System<3> block({"x", "z", "angle"}, [](auto, const auto& q, const auto& v) {
        constexpr double inertia = (half_width * half_width + half_height * half_height) / 3;
        return (v[0] * v[0] + v[1] * v[1] + inertia * v[2] * v[2]) / 2 - gravity * q[1];
      });
      for (const double side : {-1.0, 1.0}) {
        const auto gap = [=](const auto&, const auto& q) {
          using std::cos;
          using std::sin;
          return q[1] - floor - half_height * cos(q[2]) + side * half_width * sin(q[2]);
        };
        const auto slip = [=](auto, const auto& q, const auto& v) {
          using std::cos;
          using std::sin;
          return v[0] + (half_height * cos(q[2]) - side * half_width * sin(q[2])) * v[2];
        };
        const std::string name = side < 0 ? "left" : "right";
        block.unilateral(name, gap, e);
        block.friction("grip of " + name, slip, 1, name);
      }
      const double height = half_height * std::cos(angle) + half_width * std::sin(angle);
      expect_rest(block, {0, {0, floor + height + 1e-9, angle}, {0, 0, 0}}, 5, 4);
    }
  }
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::rest_after_bounces_test
