// Switches without number: in a cusp between two edges, and many segments one after another.

#include "simulation/zeno_detector.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "hybrid_sphere/simulation/simulation.hpp"
#include "support/materials.hpp"

namespace hybrid_sphere::testing::zeno_detector_test {
namespace {

// Smooth ground between a half-plane and a disc that touches it at 0, both of which throw the sphere across.
// p_c = (0, 1 - kappa), so that it comes up to y = 0 at 1 - kappa = 0.8 m/s.
scene::Scene cusp() {
  scene::Scene scene{};
  scene.sphere = {2, 0.5, 0.25};  // kappa = 1/5
  scene.surface.regions = {{"left", scene::HalfPlane{{0, 0}, {-1, 0}}, belt({4, 0})},
                           {"right", scene::Circle{{5, 0}, 5, false}, belt({-4, 0})}};
  scene.initial_state.position = {0.05, -1};
  scene.initial_state.velocity = {0, 1};
  return scene;
}

TEST(Cusp, EndTheComputationInsteadOfGoingOnWithoutEnd) {
  constexpr std::uint64_t many = 1 << 20;
  Simulation simulation(cusp());
  const auto count = [&](const Switch& event) {
    if (event.index == many) throw std::logic_error("a million switches");
  };
  try {
    simulation.advance_to(10, count);
    ADD_FAILURE() << "no halt";
  } catch (const HaltedError& error) {
    EXPECT_EQ(std::string(error.what()).find("switches accumulate"), 0U) << error.what();
  }
  // A gap of y^2/10 is crossed at 0.8 m/s, and y = 0.8 m/s t: y' = -y^2/10 per throw, and y = 10/n after n
  // throws with two switches each: 7e-6 of the radius after 290,000 of them.
  EXPECT_LT(std::abs(simulation.state().position.y()), 2 * 1.9e-5);
  EXPECT_LT(std::abs(simulation.state().position.x()), 1e-8);
}

/// At once, not after as many switches as a cusp is told from a neck by.
void expect_accumulation(Simulation& simulation) {
  try {
    simulation.advance_to(10, {});
    ADD_FAILURE() << "no halt";
  } catch (const HaltedError& error) {
    EXPECT_EQ(std::string(error.what()).find("switches accumulate"), 0U) << error.what();
  }
  EXPECT_LT(simulation.switches(), 20000U);
}

// Deep in the cusp nothing but its tip lies ahead.
TEST(Cusp, EndTheComputationAtOnceNextToItsTip) {
  scene::Scene scene = cusp();
  scene.initial_state.position = {4e-12, -1e-5};
  Simulation simulation(scene);
  expect_accumulation(simulation);
}

// The edge on the left is that of a circle, too: beside the other one, or round it.
TEST(Cusp, OfTwoCirclesEndTheComputationNextToItsTip) {
  for (const scene::Circle& left : {scene::Circle{{-5, 0}, 5, false}, scene::Circle{{10, 0}, 10, true}}) {
    scene::Scene scene = cusp();
    scene.surface.regions[0].shape = left;
    scene.initial_state.position = {7.5e-12, -1e-5};
    Simulation simulation(scene);
    expect_accumulation(simulation);
    EXPECT_LT(simulation.state().position.norm(), 2e-5);
  }
}

// Two belts throw the sphere to and fro between a line and a circle 1e-8 m away from it: 440,000 times, and
// then it is through.
TEST(Neck, AreGoneThrough) {
  scene::Scene scene{};
  scene.sphere = {1, 0.25, 0.25 * std::sqrt(0.4)};
  scene.initial_state = {{-0.3, 0.005}, Quaterniond::Identity(), {1, -5}, {-50, 4, 0}};
  scene.surface.regions = {{"floor", scene::HalfPlane{{0, 0}, {0, -1}}, belt({0, 17.5})},
                           {"disc", scene::Circle{{0, 1 + 1e-8}, 1, false}, belt({0, -17.5})}};
  Simulation simulation(scene);
  ASSERT_NO_THROW(simulation.advance_to(0.5, {}));
  EXPECT_GT(simulation.switches(), 400000U);
  EXPECT_NEAR(simulation.state().position.x(), 0.2, 1e-6);
}

// Up to `blocks` times many_instants.
template <class Time>
bool sees(const Time& time, int blocks, std::uint64_t edges) {
  SlowZenoDetector accumulation;
  accumulation.begin(0);
  for (int n = 1; n <= blocks; ++n) {
    accumulation.count_block(time(n));
    if (accumulation.seen(edges)) return true;
  }
  return false;
}

// Euler's first step off an oblique edge leads back over it before it leads away, as often as one looks.
TEST(SwitchesWithinAFixedStep, EndTheComputationInsteadOfGoingOnWithoutEnd) {
  scene::Scene scene{};
  scene.sphere = {1.75, 0.25, 0.078125};
  scene.forces.gravity = {0.25, -0.875, -8};
  scene.surface.livelock = scene::Livelock::slide;
  scene.surface.base = belt({7, -6});
  scene.surface.regions = {{"half", scene::HalfPlane{{-0.5, 1}, {4, -2}}, belt({-2.5, 5})}};
  scene.initial_state.position = {-0.5, 1};
  scene.initial_state.velocity = {4, 8};
  scene.initial_state.angular_velocity = {-3, 4.25, -3.125};
  scene.solver.method = scene::Solver::Method::euler;
  scene.solver.step = 0.125;
  constexpr std::uint64_t many = 1 << 17;
  Simulation simulation(scene);
  const auto count = [&](const Switch& event) {
    if (event.index == many) throw std::logic_error("a hundred thousand switches");
  };
  EXPECT_THROW(simulation.advance_to(8, count), HaltedError);
  EXPECT_NEAR(simulation.time(), 0.6125710227, 1e-9);  // the end of the slide along the edge
}

/// So many arrivals at one edge, at a distance in time, each after the sphere has gone back from it without
/// arriving anywhere else: thrown back by one ground, or as a slip ends there.
ZenoDetector returned(std::uint64_t count, double distance, bool thrown) {
  ZenoDetector returns;
  for (std::uint64_t i = 0; i < count; ++i) {
    ZenoDetector::Arrival arrival;
    arrival.left = 1;
    arrival.entered = 2;
    arrival.reached = thrown ? 1 : 2;
    arrival.struck = thrown;
    arrival.time = distance * static_cast<double>(i);
    arrival.position.x() = arrival.time;
    returns.next() = arrival;
    returns.add();
  }
  return returns;
}

TEST(ReturnsInNoTime, AreSeenWhateverTheClockResolves) {
  for (const bool thrown : {true, false}) {
    SCOPED_TRACE(thrown);
    EXPECT_TRUE(returned(5000, 2e-16, thrown).stands(1));
    EXPECT_FALSE(returned(4000, 2e-16, thrown).stands(1));
    EXPECT_FALSE(returned(5000, 2e-16, thrown).stands(1e-4)) << "the motion takes no longer";
    EXPECT_FALSE(returned(5000, 1e-9, thrown).stands(1));
  }
}

/// Arrivals at the lines of three regions that differ by a rounding, in turn.
/// @param distance  in time [s]
/// @param change    of the velocity from one to the next [m/s]
ZenoDetector went_round(std::uint64_t count, double distance, double change) {
  ZenoDetector returns;
  for (std::uint64_t i = 0; i < count; ++i) {
    ZenoDetector::Arrival arrival;
    arrival.left = static_cast<RegionId>(i % 3);
    arrival.entered = base_region;
    arrival.reached = static_cast<RegionId>((i + 1) % 3);
    arrival.time = 2.5;
    arrival.remainder = distance * static_cast<double>(i);
    arrival.twist.velocity.x() = 1 + change * static_cast<double>(i);
    returns.next() = arrival;
    returns.add();
  }
  return returns;
}

TEST(ReturnsOfOneState, AreSeenWhereTheyTakeNoTime) {
  EXPECT_TRUE(went_round(70, 0, 0).stands(1));
  EXPECT_TRUE(went_round(70, 1e-16, 0).stands(1));
  EXPECT_TRUE(went_round(70, 0, 0).stands(never)) << "without forces";
  EXPECT_FALSE(went_round(66, 0, 0).stands(1)) << "so few";
  EXPECT_FALSE(went_round(70, 1e-3, 0).stands(1)) << "a periodic motion";
  EXPECT_FALSE(went_round(70, 0, 1e-15).stands(1)) << "the velocity changes";
}

/// So many crossings of the edge of a polygon to and fro, in intervals of a power of their number.
/// @param pieces  of that edge, in turn
ZenoDetector crossed(std::uint64_t count, double interval, double power, std::uint64_t pieces) {
  ZenoDetector returns;
  double time = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    const bool in = i % 2 == 0;
    ZenoDetector::Arrival arrival;
    arrival.left = in ? base_region : 0;
    arrival.entered = arrival.reached = in ? 0 : base_region;
    arrival.contact = {0, {EdgePiece::Kind::line, static_cast<std::int32_t>(i / 2 % pieces)}};
    arrival.time = time;
    returns.next() = arrival;
    returns.add();
    time += interval * std::pow(static_cast<double>(i + 1), power);
  }
  return returns;
}

TEST(CrossingsToAndFro, AreAChatterWhereTheyAreShortAndOfOnePlace) {
  EXPECT_TRUE(crossed(5000, 1e-4, 0, 1).chatters(1, false));
  EXPECT_FALSE(crossed(4000, 1e-4, 0, 1).chatters(1, false)) << "so few";
  EXPECT_FALSE(crossed(5000, 1e-2, 0, 1).chatters(1, false)) << "so long";
  EXPECT_TRUE(crossed(70000, 5e-3, 0, 1).chatters(1, true)) << "so long and so many";
  EXPECT_FALSE(crossed(70000, 1e-2, 0, 1).chatters(1, true)) << "longer";
  EXPECT_FALSE(crossed(70000, 5e-3, 0, 1).chatters(1, false)) << "no errors of an integration";
  EXPECT_FALSE(crossed(5000, 1e-8, 1, 1).chatters(1, false)) << "they grow";
  EXPECT_FALSE(crossed(5000, 1e-4, 0, 2).chatters(1, false)) << "teeth of a comb";
  EXPECT_TRUE(crossed(5000, 0.1, -1, 2).chatters(1, false)) << "they shrink";
}

TEST(SlowZenoDetector, IsSeenWhereTheClockComesLessAndLessFar) {
  const auto algebraic = [](double n) { return 1 - 1 / n; };
  const auto slower = [](double n) { return 1 - 1 / std::sqrt(n); };
  EXPECT_FALSE(sees(algebraic, 31, 2));
  EXPECT_TRUE(sees(algebraic, 64, 2));
  EXPECT_TRUE(sees(slower, 64, 2));
}

TEST(SlowZenoDetector, IsNotSeenAtAnEvenPaceOrWhereSpeedGrows) {
  EXPECT_FALSE(sees([](double n) { return n; }, 1 << 12, 2));
  EXPECT_FALSE(sees([](double n) { return std::sqrt(n); }, 1 << 12, 2));
  EXPECT_FALSE(sees([](double n) { return std::log1p(n); }, 1 << 12, 2));  // exponentially
}

TEST(SlowZenoDetector, IsNotSeenOnNewEdges) {
  const auto algebraic = [](double n) { return 1 - 1 / n; };
  constexpr std::uint64_t blocks = 1 << 12;
  EXPECT_FALSE(sees(algebraic, blocks, blocks * SlowZenoDetector::many_instants));
}

// Thrown to and fro between two belts that are a metre apart: the orientation goes through thousands of
// segments, each of which rounds it.
TEST(ZenoDetector, AnOrientationStaysUnitThroughThousandsOfSwitches) {
  scene::Scene scene = cusp();
  scene.surface.regions[1].shape = scene::HalfPlane{{1, 0}, {1, 0}};
  scene.initial_state.position = {0.5, 0};
  scene.initial_state.velocity = {0.025, 1};
  scene.initial_state.angular_velocity = {0.3, -0.2, 0.7};  // p_c.x = 0
  Simulation simulation(scene);
  simulation.advance_to(20000, {});
  EXPECT_GT(simulation.switches(), 10000U);
  EXPECT_NEAR(simulation.state().orientation.norm(), 1, 8 * 0x1p-52);  // of one segment
}

}  // namespace
}  // namespace hybrid_sphere::testing::zeno_detector_test
