// Coulomb friction under loads that are known: sticking and slipping.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "hybrid_sphere/mechanics/plant.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::friction_test {
namespace {

class Friction : public ::testing::TestWithParam<double> {
 protected:
  Options options() const {
    Options options;
    options.accuracy = GetParam();
    return options;
  }
};

/// A block of unit mass on a spring k and a belt of speed u, which grips it with at most `grip`.
Model block_on_a_belt(double k, double u, double mu, double load) {
  System<1> block({"x"},
                  [k](auto, const auto& q, const auto& v) { return v[0] * v[0] / 2 - k * q[0] * q[0] / 2; });
  block.friction(
      "grip", [u](auto, const auto&, const auto& v) { return v[0] - u; }, mu,
      [load](double, const auto&, const auto&) { return load; });
  return block;
}

// It slips back, x = c + A cos(w t), until it is as fast as the belt, goes with it until the spring pulls as
// much as the grip holds, and slips.
TEST_P(Friction, OfABeltSticksAndSlips) {
  constexpr double k = 4, u = 0.5, mu = 0.3, load = 9.81, w = 2, c = mu * load / k, A = 1;
  const Solution motion = solve(block_on_a_belt(k, u, mu, load), {0, {c + A}, {0.0}}, 5, options());
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  ASSERT_GE(motion.switches().size(), 2u);
  const double stick = (M_PI + std::asin(u / (A * w))) / w;
  EXPECT_EQ(motion.at(0).sliding, (Slides{{0, -1}}));
  EXPECT_EQ(motion.switches()[0].applied, ActiveSet{0});
  EXPECT_NEAR(motion.switches()[0].time, stick, 5 * GetParam());
  const double x = c + A * std::cos(w * stick);
  EXPECT_EQ(motion.switches()[1].released, ActiveSet{0});
  EXPECT_NEAR(motion.switches()[1].time, stick + (c - x) / u, 20 * GetParam());
  EXPECT_EQ(motion.switches()[1].sliding, (Slides{{0, -1}}));
}

// What comes to rest stays there.
TEST_P(Friction, BringsABlockToRest) {
  constexpr double mu = 0.2, load = 9.81, speed = 3;
  const Solution motion = solve(block_on_a_belt(0, 0, mu, load), {0, {0.0}, {speed}}, 5, options());
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  ASSERT_EQ(motion.switches().size(), 1u);
  EXPECT_NEAR(motion.switches()[0].time, speed / (mu * load), 5 * GetParam());
  EXPECT_EQ(motion.at(5).v[0], 0);
  EXPECT_NEAR(motion.at(5).q[0], speed * speed / (2 * mu * load), 5 * GetParam());
  EXPECT_LT(motion.steps(), 100u);
}

// A push that grows, t, and turns round: it slips where t reaches the limit. Without inertia of the grip, the
// slip reverses without sticking where the push at that instant is beyond the limit.
TEST_P(Friction, UnderAPushSticksSlipsAndReverses) {
  System<1> block(
      {"x"}, [](auto, const auto&, const auto& v) { return v[0] * v[0] / 2; },
      [](double t, const auto&, const auto&) { return Eigen::Matrix<double, 1, 1>(10 * std::sin(t)); });
  block.friction(
      "grip", [](auto, const auto&, const auto& v) { return v[0]; }, 0.5,
      [](double, const auto&, const auto&) { return 4.0; });
  const Solution motion = solve(block, {0, {0.0}, {0.0}}, 6, options());
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  ASSERT_EQ(motion.switches().size(), 2u);
  const double slips = std::asin(0.2);
  EXPECT_NEAR(motion.switches()[0].time, slips, 5 * GetParam());
  EXPECT_EQ(motion.switches()[0].sliding, (Slides{{0, 1}}));
  // v = 10 (cos(slips) - cos(t)) - 2 (t - slips)
  const double t = motion.switches()[1].time;
  EXPECT_NEAR(10 * (std::cos(slips) - std::cos(t)) - 2 * (t - slips), 0, 50 * GetParam());
  EXPECT_LT(10 * std::sin(t), -2);
  EXPECT_EQ(motion.switches()[1].sliding, (Slides{{0, -1}}));
  EXPECT_TRUE(motion.switches()[1].applied.empty() && motion.switches()[1].released.empty());
}

/// A wheel of unit mass that is steered: its axle does not slip sideways as long as it has grip.
Model steered_wheel(double grip) {
  System<2> wheel({"x", "y"},
                  [](auto, const auto&, const auto& v) { return (v[0] * v[0] + v[1] * v[1]) / 2; });
  const auto sideways = [](auto t, const auto&, const auto& v) {
    using std::cos, std::sin;
    const auto angle = 1.0 - cos(t);
    return v[1] * cos(angle) - v[0] * sin(angle);
  };
  wheel.friction("wheel", sideways, 1, [grip](double, const auto&, const auto&) { return grip; });
  return wheel;
}

// The curve wants sin(t) times the speed: the wheel loses its grip and regains it, and has its speed along
// itself as long as it holds.
TEST_P(Friction, OfASteeredWheelIsLostAndRegained) {
  constexpr double grip = 1.2, speed = 2;
  const Model model = steered_wheel(grip);
  const Solution motion = solve(model, {0, {0, 0}, {speed, 0}}, 6, options());
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  ASSERT_GE(motion.switches().size(), 2u);
  EXPECT_NEAR(motion.switches()[0].time, std::asin(grip / speed), 5 * GetParam());
  EXPECT_EQ(motion.switches()[0].released, ActiveSet{0});
  EXPECT_EQ(motion.switches()[1].applied, ActiveSet{0});
  Options finer;
  finer.accuracy = 1e-13;
  const Solution reference = solve(model, {0, {0, 0}, {speed, 0}}, 6, finer);
  ASSERT_EQ(reference.switches().size(), motion.switches().size());
  EXPECT_NEAR(motion.switches()[1].time, reference.switches()[1].time, 20 * GetParam());
  EXPECT_NEAR((motion.at(6).v - reference.at(6).v).norm(), 0, 20 * GetParam());
  for (int i = 0; i <= 600; ++i) {
    const State state = motion.at(0.01 * i);
    EXPECT_LE(std::abs(state.multipliers[0]), grip * (1 + 1e-9)) << state.time;
  }
}

/// A car of unit length without an engine that tows a trailer, steered by a torque: the front wheels are at
/// its hitch, the trailer's are L behind it. Each pair has grip sideways as long as its load allows.
Model car_with_trailer() {
  constexpr double m = 2, I = 0.5, M = 1, J = 0.3, L = 1.5, torque = 2;
  System<4> car(
      {"x", "y", "car", "trailer"},
      [=](auto, const auto& q, const auto& v) {
        using std::cos, std::sin;
        const auto vx = v[0] + L * v[3] * sin(q[3]);
        const auto vy = v[1] - L * v[3] * cos(q[3]);
        return m / 2 * (v[0] * v[0] + v[1] * v[1]) + I / 2 * v[2] * v[2] + M / 2 * (vx * vx + vy * vy) +
               J / 2 * v[3] * v[3];
      },
      [=](double t, const auto&, const auto&) { return Eigen::Vector4d(0, 0, torque * std::cos(2 * t), 0); });
  const auto front = [](auto, const auto& q, const auto& v) {
    using std::cos, std::sin;
    return v[1] * cos(q[2]) - v[0] * sin(q[2]);
  };
  const auto rear = [=](auto, const auto& q, const auto& v) {
    using std::cos, std::sin;
    return v[1] * cos(q[3]) - v[0] * sin(q[3]) - L * v[3];
  };
  car.friction("front", front, 0.5, [](double, const auto&, const auto&) { return 2 * 9.81; });
  car.friction("rear", rear, 0.15, [](double, const auto&, const auto&) { return 9.81; });
  return car;
}

TEST_P(Friction, OfTheWheelsOfATrailerIsLostAndRegained) {
  const Model model = car_with_trailer();
  const Initial start{0, {0, 0, 0, 0}, {3, 0, 0, 0}};
  const Solution motion = solve(model, start, 6, options());
  Options finest;
  finest.accuracy = 1e-13;
  const Solution reference = solve(model, start, 6, finest);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  ASSERT_EQ(motion.switches().size(), reference.switches().size());
  std::array<int, 2> lost{}, regained{};
  for (std::size_t i = 0; i < motion.switches().size(); ++i) {
    const Switch& change = motion.switches()[i];
    EXPECT_NEAR(change.time, reference.switches()[i].time, 20 * GetParam()) << i;
    EXPECT_EQ(change.active, reference.switches()[i].active) << i;
    EXPECT_NEAR(change.energy_before, change.energy_after, 1e-12) << i;
    for (const std::size_t wheel : change.released) ++lost[wheel];
    for (const std::size_t wheel : change.applied) ++regained[wheel];
  }
  for (const std::size_t wheel : {0u, 1u}) {
    EXPECT_GE(lost[wheel], 1) << wheel;
    EXPECT_GE(regained[wheel], 1) << wheel;
  }
  for (int i = 0; i <= 300; ++i) {
    const State state = motion.at(0.02 * i);
    EXPECT_LE(std::abs(state.multipliers[0]), 9.81 * (1 + 1e-9)) << state.time;
    EXPECT_LE(std::abs(state.multipliers[1]), 0.15 * 9.81 * (1 + 1e-9)) << state.time;
    EXPECT_NEAR((state.v - reference.at(state.time).v).norm(), 0, 20 * GetParam()) << state.time;
  }
}

INSTANTIATE_TEST_SUITE_P(AtEachAccuracy, Friction, ::testing::Values(1e-6, 1e-9, 1e-12));

// A belt that starts: the block does not jump to its speed, but slides until it has it.
TEST(FrictionOfAnInput, SlidesWhereTheInputMovesTheBelt) {
  constexpr double mu = 0.2, load = 9.81;
  const auto model = [](const Vector& u) { return block_on_a_belt(0, u[0], mu, load); };
  Plant plant(model, {0.0}, {0, {0.0}, {0.0}});
  plant.advance(1);
  EXPECT_EQ(plant.state().active, ActiveSet{0});
  plant.set_input({1.0});
  std::vector<Switch> switches;
  plant.advance(3, [&](const Switch& s) { switches.push_back(s); });
  ASSERT_EQ(switches.size(), 2u);
  EXPECT_EQ(switches[0].time, 1);
  EXPECT_EQ(switches[0].released, ActiveSet{0});
  EXPECT_EQ(switches[0].v_after[0], 0);
  EXPECT_EQ(switches[0].sliding, (Slides{{0, -1}}));
  EXPECT_NEAR(switches[1].time, 1 + 1 / (mu * load), 1e-8);
  EXPECT_EQ(plant.state().v[0], 1);
}

TEST(FrictionOfAModel, IsRefusedWhereItMakesNoSense) {
  const auto refused = [](const Model& model, const char* why) {
    try {
      check(model);
      ADD_FAILURE() << "not refused: " << why;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
  };
  refused(block_on_a_belt(1, 0, -0.1, 1), "friction grip: coefficient = -0.1");
  refused(block_on_a_belt(1, 0, std::nan(""), 1), "coefficient = nan");
  Model model = block_on_a_belt(1, 0, 0.1, 1);
  model.constraints[0].friction->load = nullptr;
  refused(model, "it has no load");
  model.constraints[0].friction->contact = 0;
  refused(model, "not that of a unilateral constraint");
  System<1> ball({"z"}, [](auto, const auto&, const auto& v) { return v[0] * v[0] / 2; });
  ball.unilateral(
      "floor", [](const auto&, const auto& q) { return q[0]; }, 1.5);
  refused(ball, "constraint floor: restitution = 1.5");
  EXPECT_THROW(ball.friction(
                   "grip", [](auto, const auto&, const auto& v) { return v[0]; }, 0.1, "ceiling"),
               std::invalid_argument);
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::friction_test
