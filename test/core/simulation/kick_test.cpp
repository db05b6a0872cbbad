// Impulses on the centre from outside, one claim a case.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "hybrid_sphere/simulation/simulation.hpp"
#include "support/materials.hpp"
#include "support/recorded.hpp"

namespace hybrid_sphere::testing::kick_test {
namespace {

using scene::Law;

constexpr double ulps = 4.5e-16;  // two roundings of numbers near 1

// k = R/2, so that kappa = 1/5; gravity 8 m/s^2.
scene::Scene scene_on(const scene::Material& ground, const Vector2d& velocity = Vector2d::Zero()) {
  scene::Scene scene{};
  scene.sphere = {2, 0.5, 0.25};
  scene.forces.gravity = {0, 0, -8};
  scene.surface.base = ground;
  scene.initial_state.velocity = velocity;
  return scene;
}

// Left of x = 0 the base, right of it the other.
scene::Scene two_grounds(const scene::Material& left, const scene::Material& right) {
  scene::Scene scene = scene_on(left);
  scene.surface.regions = {{"right", scene::HalfPlane{{0, 0}, {1, 0}}, right}};
  return scene;
}

Switches switches_of(Simulation& simulation, double until) {
  Switches switches;
  simulation.advance_to(until, recorder(switches));
  return switches;
}

void expect_near(const Vector2d& value, const Vector2d& expected, double tolerance) {
  EXPECT_LE((value - expected).norm(), tolerance) << value.transpose() << " is not " << expected.transpose();
}

TEST(Kick, OnSmoothGroundChangesTheVelocityAlone) {
  scene::Scene scene = scene_on(Law::smooth, {1, 0.5});
  scene.initial_state.angular_velocity = {0.25, 0.5, 3};
  Simulation simulation(scene);
  simulation.advance_to(0.5, {});
  simulation.kick({-1, 2});
  EXPECT_TRUE(switches_of(simulation, 2.5).empty());
  const State& state = simulation.state();
  EXPECT_EQ(state.twist.velocity, Vector2d(0.5, 1.5));
  EXPECT_EQ(state.twist.angular_velocity, Vector3d(0.25, 0.5, 3));
  EXPECT_EQ(state.slip, Vector2d(0.25, 1.625));
  EXPECT_EQ(state.position, Vector2d(0.5 + 0.5 * 2, 0.25 + 1.5 * 2));
}

TEST(Kick, ActsInTheNextAdvanceAtTheSameTime) {
  Simulation simulation(scene_on(Law::smooth));
  simulation.advance_to(1, {});
  simulation.kick({2, 0});
  simulation.advance_to(1, {});
  EXPECT_EQ(simulation.time(), 1);
  EXPECT_EQ(simulation.state().twist.velocity, Vector2d(1, 0));
  EXPECT_EQ(simulation.state().position, Vector2d::Zero());
}

// delta v = J/(m (1 + k^2/R^2)) = 0.8 J/m, delta omega = (-delta v_y, delta v_x)/R.
TEST(Kick, OfARollingSphereIsAnsweredByTheGroundSoThatItRollsOn) {
  Simulation simulation(scene_on(Law::rough));
  switches_of(simulation, 1);
  simulation.kick({2, -1});
  EXPECT_TRUE(switches_of(simulation, 1).empty());
  const State& state = simulation.state();
  expect_near(state.twist.velocity, {0.8, -0.4}, ulps);
  expect_near(state.twist.angular_velocity.head<2>(), {0.8, 1.6}, 2 * ulps);
  EXPECT_EQ(state.slip, Vector2d::Zero());
  EXPECT_EQ(state.mode, Mode::rolling);
  simulation.advance_to(2, {});
  expect_near(simulation.state().position, {0.8, -0.4}, ulps);
}

TEST(Kick, OnABeltKeepsTheSphereFromSlippingOnIt) {
  Simulation simulation(scene_on(belt({1, 0.5})));
  switches_of(simulation, 1);  // v = kappa u
  simulation.kick({2, 0});
  EXPECT_TRUE(switches_of(simulation, 1.5).empty());
  expect_near(simulation.state().twist.velocity, {0.2 + 0.8, 0.1}, ulps);
  EXPECT_EQ(simulation.state().slip, Vector2d::Zero());
}

TEST(Kick, OnRubberLeavesTheSpinAtThatOfTheGround) {
  scene::Scene scene = scene_on(Law::rubber);
  scene.surface.base.turntable_rate = 0.75;
  Simulation simulation(scene);
  switches_of(simulation, 1);
  simulation.kick({2, 0});
  EXPECT_TRUE(switches_of(simulation, 1).empty());
  expect_near(simulation.state().twist.velocity, {0.8, 0}, ulps);
  EXPECT_EQ(simulation.state().twist.angular_velocity.z(), 0.75);
}

// The slip J/m = 1 dies after kappa/(mu g) = 0.1 s; then v = 0.8 J/m.
TEST(Kick, OnCoulombGroundMakesTheSphereSlideUntilTheSlipHasDied) {
  Simulation simulation(scene_on(coulomb(0.25)));
  switches_of(simulation, 1);
  simulation.kick({2, 0});
  Switches switches = switches_of(simulation, 1);
  ASSERT_EQ(switches.size(), 1U);
  EXPECT_EQ(switches[0].kind, SwitchKind::released);
  EXPECT_EQ(switches[0].cause, Cause::kicked);
  EXPECT_EQ(switches[0].time, 1);
  EXPECT_EQ(switches[0].impulse, Vector2d::Zero());
  EXPECT_EQ(switches[0].before.velocity, Vector2d(1, 0));
  EXPECT_EQ(simulation.state().slip, Vector2d(1, 0));
  EXPECT_EQ(simulation.state().mode, Mode::sliding);
  EXPECT_EQ(simulation.state().stage, Stage::holonomic);
  switches = switches_of(simulation, 2);
  ASSERT_EQ(switches.size(), 1U);
  EXPECT_EQ(switches[0].cause, Cause::slip_ended);
  EXPECT_NEAR(switches[0].time, 1.1, ulps);
  expect_near(simulation.state().twist.velocity, {0.8, 0}, ulps);
}

TEST(Kick, OfASlidingSphereAddsToItsSlipAndIsNoSwitch) {
  Simulation simulation(scene_on(coulomb(0.25), {1, 0}));  // v' = -2, slip' = -10
  simulation.advance_to(0.0625, {});
  simulation.kick({0, 2});
  EXPECT_TRUE(switches_of(simulation, 0.0625).empty());
  expect_near(simulation.state().slip, {0.375, 1}, ulps);
  EXPECT_EQ(simulation.state().mode, Mode::sliding);
}

// With rho = 1/32 it takes rho (1 - kappa) g = 0.2 m/s^2 from the rolling sphere.
TEST(Kick, SetsASphereRollingThatAResistanceHeld) {
  scene::Scene scene = scene_on(Law::rough);
  scene.surface.base.rolling_resistance = 1.0 / 32;
  Simulation simulation(scene);
  switches_of(simulation, 1);
  EXPECT_EQ(simulation.state().mode, Mode::resting);
  simulation.kick({2, 0});
  EXPECT_TRUE(switches_of(simulation, 2).empty());
  EXPECT_EQ(simulation.state().mode, Mode::rolling);
  expect_near(simulation.state().twist.velocity, {0.6, 0}, ulps);
  EXPECT_TRUE(switches_of(simulation, 10).empty());
  EXPECT_EQ(simulation.state().mode, Mode::resting);
  EXPECT_NEAR(simulation.state().position.x(), 0.8 * 0.8 / (2 * 0.2), 4 * ulps);
}

TEST(Kick, ChangesTheConservedVelocityByTheSameOnEveryGround) {
  scene::Material turntable(Law::rough);
  turntable.turntable_rate = 0.5;
  for (const scene::Material& ground :
       {scene::Material(Law::smooth), scene::Material(Law::rough), scene::Material(Law::rubber),
        coulomb(0.25), belt({1, 2}), turntable}) {
    Simulation simulation(scene_on(ground, {1, 0.5}));
    simulation.advance_to(0.75, {});
    const Sphere& sphere = simulation.sphere();
    const Vector2d before = sphere.conserved_velocity(simulation.state().twist);
    simulation.kick({2, -1});
    simulation.advance_to(0.75, {});
    const Vector2d after = sphere.conserved_velocity(simulation.state().twist);
    SCOPED_TRACE(scene::to_string(ground.law));
    expect_near(after - before, {0.8, -0.4}, 8 * ulps);
  }
}

TEST(Kick, OfASphereOnAnEdgeDecidesOnWhichGroundItGoesOn) {
  for (const double direction : {-1.0, 1.0}) {
    Simulation simulation(two_grounds(Law::smooth, Law::rough));
    ASSERT_EQ(switches_of(simulation, 1).size(), 1U);  // on the edge the topmost ground
    simulation.kick({2 * direction, 0});
    const Switches switches = switches_of(simulation, 2);
    if (direction > 0) {
      EXPECT_TRUE(switches.empty());
      expect_near(simulation.state().position, {0.8, 0}, ulps);
    } else {
      ASSERT_EQ(switches.size(), 1U);
      EXPECT_EQ(switches[0].kind, SwitchKind::released);
      EXPECT_EQ(switches[0].cause, Cause::kicked);
      EXPECT_EQ(switches[0].from, "right");
      EXPECT_EQ(switches[0].to, "base");
      EXPECT_EQ(switches[0].impulse, Vector2d::Zero());
      EXPECT_EQ(simulation.state().position, Vector2d(-1, 0));
    }
  }
}

// Belts that throw the sphere at each other with kappa u = 0.2: an impulse across the edge counts 0.8 J/m.
TEST(Kick, WeakerThanTheBeltsLeavesTheSphereSlidingAlongTheirEdge) {
  Simulation simulation(two_grounds(belt({1, 0}), belt({-1, 0})));
  switches_of(simulation, 1);
  ASSERT_EQ(simulation.state().mode, Mode::edge_sliding);
  simulation.kick({0.25, 2});
  EXPECT_TRUE(switches_of(simulation, 2).empty());
  EXPECT_EQ(simulation.state().mode, Mode::edge_sliding);
  expect_near(simulation.state().position, {0, 0.8}, ulps);
}

TEST(Kick, StrongerThanTheBeltsTakesTheSphereFromTheirEdge) {
  Simulation simulation(two_grounds(belt({1, 0}), belt({-1, 0})));
  switches_of(simulation, 1);
  simulation.kick({2, 0});
  const Switches switches = switches_of(simulation, 2);
  ASSERT_EQ(switches.size(), 1U);
  EXPECT_EQ(switches[0].kind, SwitchKind::exchanged);
  EXPECT_EQ(switches[0].cause, Cause::kicked);
  EXPECT_EQ(switches[0].to, "right");
  expect_near(simulation.state().position, {0.8 - 0.2, 0}, ulps);
}

TEST(Kick, AddsUpWithAnotherAtTheSameTime) {
  Simulation twice(scene_on(Law::rough));
  Simulation once(scene_on(Law::rough));
  for (Simulation* simulation : {&twice, &once}) simulation->advance_to(1, {});
  twice.kick({2, 0});
  twice.kick({-0.5, 1});
  once.kick({1.5, 1});
  for (Simulation* simulation : {&twice, &once}) simulation->advance_to(3, {});
  EXPECT_EQ(twice.state().position, once.state().position);
}

TEST(Kick, BeforeTheGroundHasActedIsPartOfTheInitialState) {
  Simulation kicked(scene_on(Law::rough, {1, 0}));
  kicked.kick({2, 4});
  Simulation expected(scene_on(Law::rough, {2, 2}));
  ASSERT_EQ(switches_of(kicked, 1).size(), 1U);
  expected.advance_to(1, {});
  EXPECT_EQ(kicked.state().position, expected.state().position);
}

TEST(Kick, OverANewMapActsOnItsGround) {
  Simulation simulation(scene_on(Law::rough));
  simulation.advance_to(1, {});
  simulation.kick({2, 0});
  scene::Surface surface;
  surface.base = Law::smooth;
  simulation.set_surface(surface);
  ASSERT_EQ(switches_of(simulation, 1).size(), 1U);
  EXPECT_EQ(simulation.state().twist.velocity, Vector2d(1, 0));
}

TEST(Kick, ThatHasNotActedIsForgottenWithANewInitialState) {
  Simulation simulation(scene_on(Law::smooth));
  simulation.advance_to(1, {});
  simulation.kick({2, 0});
  simulation.reset();
  simulation.advance_to(1, {});
  EXPECT_EQ(simulation.state().position, Vector2d::Zero());
}

TEST(Kick, GoesWithACommandOfTheSameTime) {
  Simulation simulation(scene_on(Law::rough));
  simulation.advance_to(1, {});
  simulation.kick({2, 0});
  simulation.set_command({{1, 0}, Vector3d::Zero()});
  simulation.advance_to(3, {});
  // x = 0.8 t + 0.8 F/m t^2/2
  expect_near(simulation.state().position, {0.8 * 2 + 0.4 * 2, 0}, 4 * ulps);
}

TEST(Kick, IsRefusedWhereItIsNotFiniteAndNothingChanges) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Simulation simulation(scene_on(Law::rough, {1, 0}));
  simulation.advance_to(1, {});
  for (const Vector2d& impulse : {Vector2d(nan, 0), Vector2d(0, -infinity), Vector2d(1e16, 0)}) {
    EXPECT_THROW(simulation.kick(impulse), std::invalid_argument) << impulse.transpose();
  }
  EXPECT_TRUE(switches_of(simulation, 2).empty());
  expect_near(simulation.state().position, {1.6, 0}, 2 * ulps);
}

TEST(Kick, IsRefusedWhereTheComputationHasHalted) {
  scene::Scene scene = two_grounds(belt({1, 0}), belt({-1, 0}));
  scene.surface.livelock = scene::Livelock::stop;
  Simulation simulation(scene);
  EXPECT_THROW(simulation.advance_to(1, {}), HaltedError);
  EXPECT_THROW(simulation.kick({1, 0}), HaltedError);
}

// Closed form and integrated, straight and curved paths, with and without a switch.
TEST(Kick, GivesTheSameBitsHoweverOftenTheMotionIsLookedAt) {
  scene::Scene curved = two_grounds(coulomb(0.125), Law::rough);
  curved.initial_state.position = {-1, 0};
  curved.initial_state.velocity = {0.7, 0.3};
  curved.initial_state.angular_velocity = {1, -2, 0.5};
  curved.forces.gravity = {0.3, 0.2, -8};
  scene::Scene integrated = curved;
  integrated.forces.drag.quadratic = 0.1;
  for (const scene::Scene& scene : {curved, integrated}) {
    Simulation seldom(scene);
    Simulation often(scene);
    Switches of_seldom;
    Switches of_often;
    const auto look_until = [&](double until) {
      const double from = often.time();
      for (int i = 1; i <= 97; ++i) {
        often.advance_to(i < 97 ? from + (until - from) * i / 97 : until, recorder(of_often));
        EXPECT_TRUE(often.state().position.allFinite());
      }
      seldom.advance_to(until, recorder(of_seldom));
    };
    for (const double time : {0.3, 1.7, 2.9}) {
      look_until(time);
      for (Simulation* simulation : {&seldom, &often}) simulation->kick({-1.3, 0.4 * time});
    }
    look_until(5);
    EXPECT_EQ(seldom.state().position, often.state().position);
    EXPECT_EQ(seldom.state().orientation.coeffs(), often.state().orientation.coeffs());
    EXPECT_EQ(seldom.state().twist.velocity, often.state().twist.velocity);
    ASSERT_EQ(of_seldom.size(), of_often.size());
    EXPECT_GE(of_seldom.size(), 2U);
    for (std::size_t i = 0; i < of_seldom.size(); ++i) {
      EXPECT_EQ(of_seldom[i].time, of_often[i].time);
      EXPECT_EQ(of_seldom[i].impulse, of_often[i].impulse);
    }
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::kick_test
