// Contacts and frictions where forces just cancel, or motions begin or end by rounding.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/mechanics/contact_systems.hpp"
#include "hybrid_sphere/mechanics/plant.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"

namespace hybrid_sphere::mechanics::contact_start_test {
namespace {

using testing::gravity;

Options accurate(double accuracy) {
  Options options;
  options.accuracy = accuracy;
  return options;
}

Model pulled_ball(double rate) {
  System<1> ball(
      {"z"}, [](auto, const auto& q, const auto& v) { return v[0] * v[0] / 2 - gravity * q[0]; },
      [rate](double t, const auto&, const auto&) { return Eigen::Matrix<double, 1, 1>(rate * t); });
  ball.unilateral("floor", [](const auto&, const auto& q) { return q[0]; });
  return ball;
}

// It lifts off when the pull is its weight, and is then at rate s^3/6.
TEST(ContactStart, OfABallThatIsLiftedByAGrowingPull) {
  for (const double rate : {0.5, 3.0, 20.0}) {
    for (const double accuracy : {1e-3, 1e-6, 1e-9, 1e-12}) {
      const double lifts = gravity / rate;
      const Solution motion = solve(pulled_ball(rate), {0, {0.0}, {0.0}}, 2 * lifts, accurate(accuracy));
      ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
      ASSERT_EQ(motion.switches().size(), 1u);
      EXPECT_NEAR(motion.switches()[0].time, lifts, 1e-12 * lifts);
      const double height = rate * std::pow(lifts, 3) / 6;
      EXPECT_NEAR(motion.at(2 * lifts).q[0], height, height * std::max(accuracy, 1e-13));
      EXPECT_LT(motion.steps(), 100u);
    }
  }
}

// It begins to slip when the push is mu N, whatever the numbers.
TEST(ContactStart, OfASlipUnderAGrowingPush) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> exponent(-2, 2);
  for (int i = 0; i < 60; ++i) {
    const double mu = std::pow(10, exponent(random)), load = std::pow(10, exponent(random));
    const double rate = std::pow(10, exponent(random)), mass = std::pow(10, exponent(random));
    System<1> block(
        {"x"}, [mass](auto, const auto&, const auto& v) { return mass * v[0] * v[0] / 2; },
        [rate](double t, const auto&, const auto&) { return Eigen::Matrix<double, 1, 1>(rate * t); });
    block.friction(
        "grip", [](auto, const auto&, const auto& v) { return v[0]; }, mu,
        [load](double, const auto&, const auto&) { return load; });
    const double slips = mu * load / rate;
    const Solution motion = solve(block, {0, {0.0}, {0.0}}, 2 * slips);
    SCOPED_TRACE(::testing::Message() << mu << ' ' << load << ' ' << rate << ' ' << mass);
    ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
    ASSERT_EQ(motion.switches().size(), 1u);
    EXPECT_NEAR(motion.switches()[0].time, slips, 1e-11 * slips);
    const double way = rate * std::pow(slips, 3) / (6 * mass);
    EXPECT_NEAR(motion.at(2 * slips).q[0], way, 1e-9 * way);
  }
}

// A box whose corner falls on the ground slides on, flat.
TEST(ContactStart, OfABoxThatComesToSlideFlat) {
  constexpr double width = 0.3, height = 0.5, mu = 0.05;
  for (int i = 1; i <= 20; ++i) {
    const double tilt = 0.01 * i;
    System<3> box({"x", "z", "angle"}, [](auto, const auto& q, const auto& v) {
      return (v[0] * v[0] + v[1] * v[1] + 0.1 * v[2] * v[2]) / 2 - gravity * q[1];
    });
    for (const double side : {-width, width}) {
      const std::string name = side < 0 ? "left" : "right";
      box.unilateral(name, [side](const auto&, const auto& q) {
        using std::cos, std::sin;
        return q[1] - height * cos(q[2]) + side * sin(q[2]);
      });
      const auto slip = [side](auto, const auto& q, const auto& v) {
        using std::cos, std::sin;
        return v[0] + (height * cos(q[2]) - side * sin(q[2])) * v[2];
      };
      box.friction("grip of " + name, slip, mu, name);
    }
    const Solution motion =
        solve(box, {0, {0, height * std::cos(tilt) + width * std::sin(tilt), tilt}, {1, 0, 0}}, 3);
    ASSERT_EQ(motion.status().stop, Stop::reached_end) << tilt << ": " << motion.status().message;
    EXPECT_NEAR(motion.at(3).q[2], 0, 1e-9) << tilt;
    EXPECT_EQ(motion.at(3).v[0], 0) << tilt;
  }
}

TEST(ContactStart, OfABallOnAShakenFloor) {
  constexpr double A = 0.066764620145911099, w = 12.418848924644124;
  System<1> ball({"z"}, [](auto, const auto& q, const auto& v) { return v[0] * v[0] / 2 - gravity * q[0]; });
  ball.unilateral("floor", [](const auto& t, const auto& q) {
    using std::sin;
    return q[0] - A * sin(w * t);
  });
  const Solution motion = solve(ball, {0, {0.1}, {0.0}}, 5);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  for (int i = 0; i <= 500; ++i) {
    const State state = motion.at(0.01 * i);
    EXPECT_GT(state.q[0] - A * std::sin(w * state.time), -1e-9) << state.time;
    EXPECT_GT(state.multipliers[0], -1e-9) << state.time;
  }
}

// Steps at rest are no longer than the push lets them be: it slips twice in each of its periods.
TEST(ContactStart, OfEachSlipOfAFastPush) {
  System<1> block(
      {"x"}, [](auto, const auto&, const auto& v) { return v[0] * v[0] / 2; },
      [](double t, const auto&, const auto&) { return Eigen::Matrix<double, 1, 1>(3.2 * std::sin(20 * t)); });
  block.friction(
      "grip", [](auto, const auto&, const auto& v) { return v[0]; }, 1,
      [](double, const auto&, const auto&) { return 3.0; });
  const double period = 2 * M_PI / 20;
  const Solution motion = solve(block, {0, {0.0}, {0.0}}, 100 * period);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  EXPECT_EQ(motion.switches().size(), 400u);
}

TEST(ContactStart, OfABallAboveAHighFloorIsAFall) {
  const Solution motion = solve(testing::bouncing_ball(0, 1e6), {0, {1e6 + 5}, {0.0}}, 2, accurate(1e-3));
  ASSERT_EQ(motion.switches().size(), 1u);
  EXPECT_NEAR(motion.switches()[0].time, std::sqrt(10 / gravity), 1e-3);
}

TEST(ContactStart, OfAFrictionIsRefusedWithoutItsContact) {
  System<2> block({"x", "z"}, [](const auto&, const auto& q, const auto& v) {
    return (v[0] * v[0] + v[1] * v[1]) / 2 - 9.81 * q[1];
  });
  block.unilateral("floor", [](const auto&, const auto& q) { return q[1]; });
  block.friction(
      "grip", [](const auto&, const auto&, const auto& v) { return v[0]; }, 0.5, "floor");
  Initial start{0, {0, 0}, {0, 0}};
  start.active = {1};
  try {
    solve(block, start, 1);
    FAIL() << "is not refused";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "active: friction grip is refused; allowed: with its contact floor");
  }
  start.active = {0, 1};
  EXPECT_EQ(solve(block, start, 1).status().stop, Stop::reached_end);
}

TEST(ContactStart, OfALiftOffWhereverForcesCancel) {
  std::mt19937 random(1);
  for (int i = 0; i < 60; ++i) {
    const auto within = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    const double weight = within(1, 10), rate = within(0.3, 3), lifts = weight / rate;
    System<1> ball(
        {"z"}, [=](const auto&, const auto& q, const auto& v) { return v[0] * v[0] / 2 - weight * q[0]; },
        [=](const auto& t, const auto&, const auto&) { return Eigen::Matrix<double, 1, 1>(rate * t); });
    ball.unilateral("floor", [](const auto&, const auto& q) { return q[0]; });
    const Solution motion = solve(ball, {0, {0.0}, {0.0}}, 2 * lifts);
    SCOPED_TRACE(::testing::Message() << "weight " << weight << ", rate " << rate);
    ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
    const double height = rate * lifts * lifts * lifts / 6;
    EXPECT_NEAR(motion.at(motion.end()).q[0], height, 1e-9 * height);
    EXPECT_LE(motion.steps(), 100u);
  }
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::contact_start_test
