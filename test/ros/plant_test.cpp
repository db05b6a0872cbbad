// The plant where the computation takes long, and where it fails.

#include "ros/node/plant.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

#include "support/patience.hpp"

namespace hybrid_sphere::ros_interface::plant_test {
namespace {

/// A sphere that rolls on a tilted turntable, so that the axis of its rotation turns as fast as the sphere.
/// Around it is ordinary ground.
scene::Scene spinning(double rate) {
  scene::Scene scene;
  scene.sphere.mass = 1;
  scene.sphere.radius = 0.1;
  scene.sphere.gyration_radius = 0.06;
  scene.surface.base = scene::Law::coulomb;
  scene.surface.base.friction = 0.3;
  scene::Material table(scene::Law::rough);
  table.turntable_rate = rate;
  scene.surface.regions = {{"table", scene::Circle{{0, 0}, 1, false}, table}};
  scene.forces.gravity.x() = 1;
  scene.initial_state.position = {0.05, 0};
  scene.initial_state.velocity = {1, 0};
  return scene;
}

struct Driven {
  explicit Driven(const scene::Scene& scene)
      : plant(
            scene, 0, [this](const Switch& event) { switches.push_back(event.time); }, [this] { ++ended; }) {}

  void wait() {
    testing::wait_until([this] { return plant.collect(); });
  }
  State state() {
    const State* state = plant.state();
    EXPECT_NE(state, nullptr);
    return *state;
  }

  std::vector<double> switches;
  std::atomic<int> ended{0};
  Plant plant;
};

void expect_equal(const State& a, const State& b) {
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.orientation.coeffs(), b.orientation.coeffs());
  EXPECT_EQ(a.twist.velocity, b.twist.velocity);
  EXPECT_EQ(a.twist.angular_velocity, b.twist.angular_velocity);
  EXPECT_EQ(a.mode, b.mode);
}

TEST(Plant, WhatTakesLongIsUnderWayAndComesToTheSameBits) {
  const scene::Scene scene = spinning(4e6);
  Driven driven(scene);
  ASSERT_FALSE(driven.plant.advance_to(0.2));
  EXPECT_TRUE(driven.plant.under_way());
  EXPECT_LT(driven.state().time, 0.2);
  EXPECT_EQ(driven.plant.pursuit()->to, 0.2);
  EXPECT_FALSE(driven.plant.advance_to(0.3));  // nothing else meanwhile
  driven.wait();
  EXPECT_EQ(driven.ended, 1);
  Simulation alone(scene);
  std::vector<double> switches;
  alone.advance_to(0.2, [&](const Switch& event) { switches.push_back(event.time); });
  expect_equal(driven.state(), alone.state());
  EXPECT_EQ(driven.switches, switches);
  EXPECT_EQ(driven.plant.switches(), alone.switches());
}

TEST(Plant, InterruptedManyTimesItComesToTheSameBits) {
  const scene::Scene scene = spinning(4e6);
  Driven driven(scene);
  int interruptions = 0;
  while (!driven.plant.advance_to(0.2)) {
    testing::give_way(std::chrono::milliseconds(3));
    const double before = driven.plant.time();
    driven.plant.stand();
    EXPECT_GE(driven.plant.time(), before);
    ++interruptions;
  }
  EXPECT_GT(interruptions, 1);
  Simulation alone(scene);
  alone.advance_to(0.2, [](const Switch&) {});
  expect_equal(driven.state(), alone.state());
}

TEST(Plant, AnEndlessComputationIsEndedByANewState) {
  Driven driven(spinning(1e15));
  ASSERT_FALSE(driven.plant.advance_to(1));
  scene::InitialState elsewhere;
  elsewhere.position = {2, 0};
  driven.plant.set_initial_state(elsewhere);
  EXPECT_FALSE(driven.plant.under_way());
  EXPECT_TRUE(driven.plant.advance_to(1));
  EXPECT_EQ(driven.state().time, 1);
  EXPECT_FALSE(driven.plant.halted());
}

TEST(Plant, AFailureElsewhereHoldsTheStateUntilAReset) {
  Driven driven(spinning(1));
  EXPECT_TRUE(driven.plant.advance_to(1));
  driven.plant.fail("no memory");
  EXPECT_EQ(driven.plant.halt(), "halted at t = 1 s: no memory");
  EXPECT_TRUE(driven.plant.advance_to(2));
  EXPECT_EQ(driven.state().time, 1);
  driven.plant.reset();
  EXPECT_FALSE(driven.plant.halted());
  EXPECT_TRUE(driven.plant.advance_to(2));
  EXPECT_EQ(driven.state().time, 2);
}

TEST(Plant, WhatTheSinkThrowsHaltsIt) {
  Plant plant(
      spinning(1), 0, [](const Switch&) { throw std::domain_error("no number"); }, [] {});
  EXPECT_TRUE(plant.advance_to(10));  // the slip ends on the way
  EXPECT_NE(plant.halt().find("the computation failed: no number"), std::string::npos) << plant.halt();
  EXPECT_NE(plant.state(), nullptr);
}

}  // namespace
}  // namespace hybrid_sphere::ros_interface::plant_test
