#include "hybrid_sphere/simulation/simulation.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "support/recorded.hpp"

namespace hybrid_sphere::testing::simulation_test {
namespace {

using scene::Law;

// k = R/2, so that kappa = 1/5 and all numbers below are short.
scene::Scene paper_scene() {
  scene::Scene scene{};
  scene.sphere = {2, 0.5, 0.25};
  scene.initial_state.position = {-1, 0};
  scene.initial_state.velocity = {1, 0.5};
  scene.initial_state.angular_velocity = {2, 4, -1};
  scene.surface.regions = {{"rough", scene::HalfPlane{{0, 0}, {1, 0}}, Law::rough}};
  return scene;
}

scene::Surface all(Law law) { return {law, {}}; }

TEST(Simulation, StandsAtTheInitialStateBeforeItIsAdvanced) {
  Simulation simulation(paper_scene());
  const State& state = simulation.state();
  EXPECT_EQ(state.time, 0);
  EXPECT_EQ(state.position, Vector2d(-1, 0));
  EXPECT_EQ(state.twist.velocity, Vector2d(1, 0.5));
  EXPECT_EQ(simulation.switches(), 0U);
}

TEST(Simulation, HasTheStateAfterTheSwitchAtItsInstant) {
  Simulation simulation(paper_scene());
  Switches switches;
  simulation.advance_to(std::nextafter(1.0, 0.0), recorder(switches));
  EXPECT_EQ(simulation.state().stage, Stage::holonomic);
  EXPECT_EQ(simulation.state().mode, Mode::free);
  EXPECT_EQ(simulation.state().region, "base");
  EXPECT_TRUE(switches.empty());
  simulation.advance_to(1, recorder(switches));
  EXPECT_EQ(simulation.state().stage, Stage::nonholonomic);
  EXPECT_EQ(simulation.state().mode, Mode::rolling);
  EXPECT_EQ(simulation.state().region, "rough");
  EXPECT_EQ(simulation.state().position, Vector2d(0, 0.5));
  ASSERT_EQ(switches.size(), 1U);
  EXPECT_EQ(switches[0].time, 1);
  // v+ = p_c = 4/5 v + 1/5 R (w2, -w1)
  EXPECT_NEAR(switches[0].after.velocity.x(), 1.2, 4e-16);
  EXPECT_NEAR(switches[0].after.velocity.y(), 0.2, 4e-16);
}

// On the edge of a rough unit square: at rest, with the spin that sends the sphere off with the velocity (1,
// 1) times `towards` when it is stopped there, since p_c = kappa R (w2, -w1) with kappa R = 1/5.
scene::Scene spinning_on_a_square(const Vector2d& position, const Vector2d& towards) {
  scene::Scene scene{};
  scene.sphere = {1, 1, 0.5};
  scene.initial_state.position = position;
  scene.initial_state.angular_velocity = {-5 * towards.y(), 5 * towards.x(), 0};
  scene.surface.regions = {{"square", scene::Polygon{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, false}, Law::rough}};
  return scene;
}

TEST(StartOnAnEdge, RollsThroughTheRegionThatTheImpulseSendsItInto) {
  const std::pair<Vector2d, Vector2d> inwards[] = {
      {{0.5, 0}, {0, 1}}, {{1, 0.5}, {-1, 0}}, {{0.5, 1}, {0, -1}}, {{0, 0.5}, {1, 0}},
      {{0, 0}, {1, 1}},   {{1, 0}, {-1, 1}},   {{1, 1}, {-1, -1}},  {{0, 1}, {1, -1}}};
  for (const auto& [position, towards] : inwards) {
    Simulation simulation(spinning_on_a_square(position, towards));
    Switches switches;
    simulation.advance_to(3, recorder(switches));
    SCOPED_TRACE("from " + std::to_string(position.x()) + ", " + std::to_string(position.y()));
    ASSERT_EQ(switches.size(), 2U);
    EXPECT_EQ(switches[0].time, 0);
    EXPECT_EQ(switches[1].time, 1);
    EXPECT_EQ(switches[1].position, position + towards);
  }
}

TEST(StartOnAnEdge, LeavesAtOnceTheRegionThatTheImpulseSendsItOutOf) {
  const std::pair<Vector2d, Vector2d> outwards[] = {
      {{0.5, 0}, {0, -1}}, {{1, 0.5}, {1, 0}}, {{0.5, 1}, {0, 1}}, {{0, 0.5}, {-1, 0}},
      {{0, 0}, {-1, -1}},  {{1, 0}, {1, 1}},   {{1, 1}, {1, 1}},   {{0, 1}, {1, 1}}};
  for (const auto& [position, towards] : outwards) {
    Simulation simulation(spinning_on_a_square(position, towards));
    Switches switches;
    simulation.advance_to(3, recorder(switches));
    SCOPED_TRACE("from " + std::to_string(position.x()) + ", " + std::to_string(position.y()));
    ASSERT_EQ(switches.size(), 2U);
    EXPECT_EQ(switches[1].time, 0);
  }
}

// Friction, the only force but that of a torque, takes the sphere off its ground as soon as it moves: the
// velocity that this begins with is 0, but for the rounding of what it is computed from.
TEST(StartOnAnEdge, LeavesAtOnceTheGroundWhoseFrictionTakesItOff) {
  scene::Scene scene = paper_scene();
  scene.sphere = {0.75, 1, 0.625};
  scene.forces.gravity = {0, 0, -8};
  scene.forces.wrench.torque = {-0.015625, 0.015625, -0.03125};
  scene.surface.base = scene::Law::rough;
  scene::Material dry(scene::Law::coulomb);
  dry.friction = 0.4375;
  for (const double angle : {0.0, 0.1, 0.7, M_PI_4, M_PI_2, 3.0, 4.5}) {
    for (const Vector2d& place : {Vector2d(0, 0), Vector2d(0.5, -0.25)}) {
      const Vector2d normal(std::cos(angle), std::sin(angle));
      scene.initial_state = {};
      scene.initial_state.position = place;
      scene.initial_state.angular_velocity = 7.625 * Vector3d(normal.y(), -normal.x(), 0);
      scene.surface.regions = {{"dry", scene::HalfPlane{place, normal}, dry}};
      Simulation simulation(scene);
      Switches switches;
      simulation.advance_to(1, recorder(switches));
      SCOPED_TRACE(::testing::Message() << angle << " " << place.x());
      ASSERT_EQ(switches.size(), 1U);
      EXPECT_EQ(switches[0].time, 0);
      EXPECT_EQ(simulation.state().region, "base");
    }
  }
}

TEST(StartOnAnEdge, OfAPathAlongASideThatEndsThereTurnsAtTheCorner) {
  // Along the upper side to the corner (1, 1), at which it is; the impulse turns it into the square.
  scene::Scene scene = spinning_on_a_square({1, 1}, {-2, -1});
  scene.initial_state.velocity = {-1, 0};
  scene.initial_state.position = {1, 1};
  Simulation simulation(scene);
  Switches switches;
  simulation.advance_to(3, recorder(switches));
  ASSERT_EQ(switches.size(), 2U);
  // p_c = 4/5 (-1, 0) + (-2, -1): through (0, 1 - 1/2.8), on the left side.
  EXPECT_NEAR(switches[1].time, 1 / 2.8, 1e-15);
  EXPECT_EQ(switches[1].position.x(), 0);
}

TEST(Simulation, RefusesToGoBackAndToTimesThatAreNone) {
  Simulation simulation(paper_scene());
  simulation.advance_to(0.5, {});
  const State before = simulation.state();
  for (const double time :
       {0.25, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(simulation.advance_to(time, {}), std::invalid_argument) << time;
  }
  EXPECT_EQ(simulation.time(), 0.5);
  EXPECT_EQ(simulation.state().position, before.position);
  EXPECT_NO_THROW(simulation.advance_to(0.5, {}));
}

TEST(Simulation, RefusesToGoBackRightAfterASwitch) {
  Simulation simulation(paper_scene());
  simulation.advance_to(1, {});
  EXPECT_THROW(simulation.advance_to(std::nextafter(1.0, 0.0), {}), std::invalid_argument);
}

TEST(Simulation, ReportsEachSwitchOnce) {
  Simulation simulation(paper_scene());
  Switches switches;
  for (const double time : {0.0, 1.0, 1.0, 1.0, 5.0, 5.0}) simulation.advance_to(time, recorder(switches));
  EXPECT_EQ(switches.size(), 1U);
  EXPECT_EQ(simulation.switches(), 1U);
}

TEST(Simulation, MayBeAdvancedWithoutASink) {
  Simulation simulation(paper_scene());
  simulation.advance_to(2, {});
  EXPECT_EQ(simulation.switches(), 1U);
}

TEST(Simulation, StartsTimeAndSwitchesAgainAfterAReset) {
  Simulation simulation(paper_scene());
  Switches first;
  simulation.advance_to(2, recorder(first));
  const State there = simulation.state();
  simulation.reset();
  EXPECT_EQ(simulation.time(), 0);
  EXPECT_EQ(simulation.switches(), 0U);
  EXPECT_EQ(simulation.state().position, Vector2d(-1, 0));
  Switches second;
  simulation.advance_to(2, recorder(second));
  ASSERT_EQ(second.size(), 1U);
  EXPECT_EQ(second[0].index, 0U);
  EXPECT_EQ(second[0].time, first[0].time);
  EXPECT_EQ(simulation.state().position, there.position);
  EXPECT_EQ(simulation.state().orientation.coeffs(), there.orientation.coeffs());
}

TEST(Simulation, ResetsToTheLastInitialState) {
  Simulation simulation(paper_scene());
  scene::InitialState elsewhere;
  elsewhere.position = {3, 4};
  simulation.set_initial_state(elsewhere);
  simulation.advance_to(1, {});
  simulation.reset();
  EXPECT_EQ(simulation.state().position, Vector2d(3, 4));
}

TEST(Simulation, AppliesTheConstraintOfAnInitialStateOnRoughGroundAtOnce) {
  Simulation simulation(paper_scene());
  simulation.advance_to(0.75, {});
  scene::InitialState inside;
  inside.position = {1, 1};
  inside.velocity = {0.5, 0};
  simulation.set_initial_state(inside);
  Switches switches;
  simulation.advance_to(0, recorder(switches));
  ASSERT_EQ(switches.size(), 1U);
  EXPECT_EQ(switches[0].kind, SwitchKind::applied);
  EXPECT_EQ(switches[0].time, 0);
  EXPECT_EQ(switches[0].from, "");
  EXPECT_EQ(switches[0].to, "rough");
  EXPECT_NEAR(switches[0].impulse.x(), -2 * 0.2 * 0.5, 1e-16);
}

TEST(Simulation, AppliesTheConstraintOfANewMapUnderTheMovingSphere) {
  scene::Scene scene = paper_scene();
  scene.surface = all(Law::smooth);
  Simulation simulation(scene);
  simulation.advance_to(0.75, {});
  simulation.set_surface(all(Law::rough));
  EXPECT_EQ(simulation.time(), 0.75);
  Switches switches;
  simulation.advance_to(0.75, recorder(switches));
  ASSERT_EQ(switches.size(), 1U);
  EXPECT_EQ(switches[0].kind, SwitchKind::applied);
  EXPECT_EQ(switches[0].time, 0.75);
  EXPECT_EQ(switches[0].position, Vector2d(-0.25, 0.375));
  EXPECT_EQ(simulation.state().position, Vector2d(-0.25, 0.375));
  EXPECT_NEAR(simulation.state().twist.velocity.x(), 1.2, 4e-16);
}

TEST(Simulation, ReleasesTheConstraintThatANewMapTakesAway) {
  Simulation simulation(paper_scene());
  simulation.advance_to(2, {});
  const Twist rolling = simulation.state().twist;
  simulation.set_surface(all(Law::smooth));
  Switches switches;
  simulation.advance_to(3, recorder(switches));
  ASSERT_EQ(switches.size(), 1U);
  EXPECT_EQ(switches[0].kind, SwitchKind::released);
  EXPECT_EQ(switches[0].index, 1U);
  EXPECT_EQ(switches[0].time, 2);
  EXPECT_EQ(switches[0].from, "rough");  // the region of the old map
  EXPECT_EQ(switches[0].to, "base");
  EXPECT_EQ(switches[0].impulse, Vector2d::Zero());
  EXPECT_EQ(simulation.state().twist.velocity, rolling.velocity);
}

TEST(Simulation, DoesNotSwitchOverANewMapWithTheSameConstraint) {
  Simulation simulation(paper_scene());
  simulation.advance_to(2, {});
  const State before = simulation.state();
  simulation.set_surface({Law::smooth, {{"other", scene::Circle{{0, 0}, 100, false}, Law::rough}}});
  Switches switches;
  simulation.advance_to(2, recorder(switches));
  EXPECT_TRUE(switches.empty());
  EXPECT_EQ(simulation.state().region, "other");
  EXPECT_EQ(simulation.state().position, before.position);
}

TEST(Simulation, KeepsTheNewMapAfterAReset) {
  Simulation simulation(paper_scene());
  simulation.set_surface(all(Law::rough));
  simulation.reset();
  Switches switches;
  simulation.advance_to(0, recorder(switches));
  ASSERT_EQ(switches.size(), 1U);
  EXPECT_EQ(simulation.surface().base.law, Law::rough);
}

TEST(Simulation, TakesManyNewMapsInARow) {
  Simulation simulation(paper_scene());
  for (int i = 0; i < 10; ++i) {
    simulation.advance_to(0.125 * i, {});
    simulation.set_surface(all(i % 2 == 0 ? Law::rough : Law::smooth));
    simulation.set_surface(all(Law::rough));
  }
  Switches switches;
  simulation.advance_to(2, recorder(switches));
  EXPECT_EQ(simulation.switches(), 1U);
  EXPECT_EQ(simulation.state().stage, Stage::nonholonomic);
}

TEST(Simulation, ThrowsBackWithTwoSwitchesAtOneInstant) {
  scene::Scene scene = paper_scene();
  scene.initial_state.angular_velocity = {0, -16, 0};  // k^2 w2 < -R xd
  Simulation simulation(scene);
  Switches switches;
  simulation.advance_to(1, recorder(switches));
  ASSERT_EQ(switches.size(), 2U);
  EXPECT_EQ(switches[0].kind, SwitchKind::applied);
  EXPECT_EQ(switches[1].kind, SwitchKind::released);
  EXPECT_EQ(switches[0].time, switches[1].time);
  EXPECT_EQ(switches[1].impulse, Vector2d::Zero());
  EXPECT_EQ(simulation.state().mode, Mode::free);
  EXPECT_EQ(simulation.state().slip, Vector2d::Zero());
  EXPECT_LT(simulation.state().twist.velocity.x(), 0);
}

TEST(Simulation, RestsAfterAnExactStopWithoutSpin) {
  scene::Scene scene = paper_scene();
  scene.initial_state.velocity = {1, 0};
  scene.initial_state.angular_velocity = {0, -8, 0};
  Simulation simulation(scene);
  simulation.advance_to(1e6, {});
  EXPECT_EQ(simulation.state().mode, Mode::resting);
  EXPECT_EQ(simulation.state().position, Vector2d(0, 0));
  EXPECT_EQ(simulation.switches(), 1U);
}

TEST(Simulation, OfASphereThatOnlySpinsRollsInPlace) {
  scene::Scene scene = paper_scene();
  scene.initial_state.position = {2, 2};
  scene.initial_state.velocity = {0, 0};
  scene.initial_state.angular_velocity = {0, 0, 3};
  Simulation simulation(scene);
  simulation.advance_to(10, {});
  EXPECT_EQ(simulation.state().mode, Mode::rolling);
  EXPECT_EQ(simulation.state().position, Vector2d(2, 2));
  EXPECT_EQ(simulation.state().twist.angular_velocity.z(), 3);
}

TEST(Simulation, PlacesASwitchExactlyOnAnAxisParallelEdge) {
  for (const double speed : {0.3, 0.7, 1.1, 1.9}) {
    scene::Scene scene = paper_scene();
    scene.initial_state.position.x() = -0.1;
    scene.initial_state.velocity.x() = speed;
    scene.surface.regions[0].shape = scene::HalfPlane{{0.3, 0}, {1, 0}};
    Simulation simulation(scene);
    Switches switches;
    simulation.advance_to(4, recorder(switches));
    ASSERT_EQ(switches.size(), 1U);
    EXPECT_EQ(switches[0].position.x(), 0.3) << "at a speed of " << speed;
  }
}

// The clock's own resolution at 2^30 s is 1e-7 s. From x = 1/3, met at the time 2^30 + 1/3, it goes on with
// 6/5.
TEST(Simulation, KnowsTheInstantOfASwitchBetterThanTheClockResolves) {
  scene::Scene scene = paper_scene();
  scene.initial_state.position = {-0x1p30, 0};
  scene.initial_state.velocity = {1, 0};
  scene.initial_state.angular_velocity = {0, 4, 0};
  scene.surface = all(Law::smooth);
  Simulation simulation(scene);
  simulation.advance_to(0x1p30, {});
  simulation.set_surface({Law::smooth, {{"rough", scene::HalfPlane{{1.0 / 3, 0}, {1, 0}}, Law::rough}}});
  simulation.advance_to(0x1p30 + 1, {});
  EXPECT_NEAR(simulation.state().position.x(), 1.0 / 3 + 1.2 * 2 / 3,
              1e-15);  // a few roundings of numbers about 1
}

TEST(Simulation, CarriesItsMotionOverAVeryLongTime) {
  Simulation simulation(paper_scene());
  simulation.advance_to(1e12, {});
  // 1.2 and its error of an ulp, for 1e12 s.
  EXPECT_NEAR(simulation.state().position.x(), 1.2 * (1e12 - 1), 1e12 * 4.5e-16);
}

TEST(Records, HaveTheNamesOfTheContract) {
  EXPECT_STREQ(to_string(Mode::free), "free");
  EXPECT_STREQ(to_string(Mode::rolling), "rolling");
  EXPECT_STREQ(to_string(Mode::resting), "resting");
  EXPECT_STREQ(to_string(SwitchKind::applied), "applied");
  EXPECT_STREQ(to_string(SwitchKind::released), "released");
  EXPECT_STREQ(to_string(Cause::kicked), "kicked");
  EXPECT_STREQ(to_string(Cause::accumulation), "accumulation");
}

}  // namespace
}  // namespace hybrid_sphere::testing::simulation_test
