// What comes from outside: maps, states, commands, accuracies. See also kick_test.cpp.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "support/interrupted.hpp"

namespace hybrid_sphere::testing::interventions_test {
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

TEST(Interventions, ANewMapKeepsTheNameOfTheRegionThatTwoNewMapsInARowTookAway) {
  scene::Scene scene = paper_scene();
  const std::string name = "a rough half-plane whose name is too long to be kept in place";
  scene.surface.regions[0].name = name;
  Simulation simulation(scene);
  simulation.advance_to(2, {});
  simulation.set_surface(all(Law::rough));
  simulation.set_surface(all(Law::smooth));
  EXPECT_EQ(simulation.state().region, name);
  Switches switches;
  simulation.advance_to(2, recorder(switches));
  ASSERT_EQ(switches.size(), 1U);
  EXPECT_EQ(switches[0].from, name);
  EXPECT_EQ(switches[0].to, "base");
}

// From the rough ground back to where the motion began: the same path, the same impulse, two seconds later.
TEST(Interventions, ASetStateKeepsTimeIndexAndInitialState) {
  const scene::Scene scene = paper_scene();
  Simulation simulation(scene);
  Switches switches;
  simulation.advance_to(2, recorder(switches));
  ASSERT_EQ(switches.size(), 1U);
  scene::InitialState again = scene.initial_state;
  again.orientation = Quaterniond(2, 0, 0, 0);
  simulation.set_state(again);
  EXPECT_EQ(simulation.time(), 2);
  EXPECT_EQ(simulation.switches(), 1U);
  EXPECT_EQ(simulation.state().position, scene.initial_state.position);
  EXPECT_EQ(simulation.state().orientation.norm(), 1);
  simulation.advance_to(4, recorder(switches));
  ASSERT_EQ(switches.size(), 2U);
  EXPECT_EQ(switches[1].index, 1U);
  EXPECT_DOUBLE_EQ(switches[1].time, 2 + switches[0].time);
  EXPECT_EQ(switches[1].impulse, switches[0].impulse);
  again.position.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(simulation.set_state(again), std::invalid_argument);
  EXPECT_EQ(simulation.time(), 4);
  simulation.reset();
  EXPECT_EQ(simulation.time(), 0);
  EXPECT_EQ(simulation.state().position, scene.initial_state.position);
}

// On rough ground the constraint is applied at once, at that time; a halt has ended.
TEST(Interventions, ASetStateAppliesTheGroundThereAndEndsAHalt) {
  scene::Scene scene = paper_scene();
  scene.surface.livelock = scene::Livelock::stop;
  scene::Material left(Law::rough);
  scene::Material right(Law::rough);
  left.belt = {8, 0};
  right.belt = {-8, 0};
  scene.surface.base = left;
  scene.surface.regions = {{"right", scene::HalfPlane{{0, 0}, {1, 0}}, right}};
  Simulation simulation(scene);
  EXPECT_THROW(simulation.advance_to(10, {}), HaltedError);
  const double halted_at = simulation.time();
  scene::InitialState state;
  state.position = {5, 0};
  simulation.set_state(state);
  Switches switches;
  simulation.advance_to(halted_at, recorder(switches));
  ASSERT_EQ(switches.size(), 1U);
  EXPECT_EQ(switches[0].time, halted_at);
  EXPECT_EQ(switches[0].to, "right");
  EXPECT_EQ(switches[0].cause, Cause::placed);
  EXPECT_LT(switches[0].impulse.x(), 0);
}

// A regular polygon around the origin.
scene::Shape round(std::size_t sides, double radius) {
  scene::Polygon polygon;
  for (std::size_t i = 0; i < sides; ++i) {
    const double angle = 2 * M_PI * static_cast<double>(i) / static_cast<double>(sides);
    polygon.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return polygon;
}

// The sanitizers tell whether the name is that of a map that has gone.
TEST(Interventions, ANewMapKeepsTheNameWhereTheNextMapIsInterruptedBeforeItActs) {
  const QuestionsEvery questions(8);
  scene::Scene scene = paper_scene();
  scene.forces.gravity = {1, 0, -9.81};
  const std::string name = "a rough half-plane whose name is too long to be kept in place";
  scene.surface.regions[0].name = name;
  Simulation simulation(scene);
  simulation.advance_to(2, {});
  scene::Surface next = all(Law::rough);
  next.regions = {{"another name that is too long to be kept in place", round(2000, 100), Law::smooth}};
  simulation.set_surface(next);
  simulation.set_interrupt([] { return true; });
  EXPECT_THROW(simulation.advance_to(3, {}), Interrupted);
  simulation.set_interrupt({});
  simulation.set_surface(all(Law::smooth));
  EXPECT_EQ(simulation.state().region, name);
  Switches switches;
  simulation.advance_to(3, recorder(switches));
  ASSERT_EQ(switches.size(), 1U);
  EXPECT_EQ(switches[0].from, name);
}

// Where the velocities are exactly the limits of what holds the sphere, nothing of the run before is left.
TEST(Interventions, AResetRepeatsARunToTheBitAlsoWhereMotionsEndAtOnce) {
  scene::Scene scene{};
  scene.sphere = {1, 0.5, 0.25};  // kappa = 1/5
  scene.forces.gravity = {0, 0, -8};
  scene.forces.spring = {{0, 0}, 1};
  scene.surface.base = scene::Material(Law::coulomb);
  scene.surface.base.friction = 0.0625;
  const double most = 0.0625 * 8 / 0.2;  // mu N = kappa K d
  for (int i = -20; i <= 20; ++i) {
    scene.initial_state.position = {most * (1 + i * std::numeric_limits<double>::epsilon()), 0};
    for (const double speed : {0.0, 1e-3, 1.0}) {
      scene.initial_state.velocity = {speed, 0};
      scene.initial_state.angular_velocity = {0, speed / scene.sphere.radius, 0};
      Simulation simulation(scene);
      Switches first, second;
      simulation.advance_to(1e-3, recorder(first));
      const RecordedState state(simulation);
      simulation.reset();
      simulation.advance_to(1e-3, recorder(second));
      EXPECT_EQ(first.size(), second.size());
      EXPECT_EQ(simulation.state().position, state.position);
      EXPECT_EQ(simulation.state().twist.velocity, state.twist.velocity);
      EXPECT_EQ(simulation.state().twist.angular_velocity, state.twist.angular_velocity);
      EXPECT_EQ(simulation.state().mode, state.mode);
    }
  }
}

TEST(Interventions, OneThatIsNoNumberIsRefusedAndChangesNothing) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  Simulation simulation(paper_scene());
  simulation.advance_to(0.5, {});
  const RecordedState before(simulation);
  scene::InitialState state = paper_scene().initial_state;
  state.velocity.x() = nan;
  EXPECT_THROW(simulation.set_initial_state(state), std::invalid_argument);
  for (int i = 0; i < 7; ++i) {
    state = paper_scene().initial_state;
    (i < 2 ? state.position[i] : i < 4 ? state.velocity[i - 2] : state.angular_velocity[i - 4]) = -2e15;
    EXPECT_THROW(simulation.set_initial_state(state), std::invalid_argument) << i;
  }
  state = paper_scene().initial_state;
  state.orientation.coeffs().setZero();
  EXPECT_THROW(simulation.set_initial_state(state), std::invalid_argument);
  for (int i = 0; i < 5; ++i) {
    for (const double number : {nan, HUGE_VAL, -1e300}) {
      scene::Wrench wrench;
      (i < 2 ? wrench.force[i] : wrench.torque[i - 2]) = number;
      EXPECT_THROW(simulation.set_command(wrench), std::invalid_argument) << i << ": " << number;
    }
  }
  for (const double accuracy : {0.0, -1.0, 1e-15, 1.5, nan}) {
    EXPECT_THROW(simulation.set_accuracy(accuracy), std::invalid_argument) << accuracy;
  }
  simulation.advance_to(0.5, {});
  EXPECT_EQ(simulation.state().position, before.position);
  EXPECT_EQ(simulation.state().time, before.time);
}

TEST(Interventions, ACommandMayAccelerateTheSphereAsAWrenchOfAScene) {
  constexpr double most = 1e15;  // [m/s^2, 1/s^2]
  const scene::Scene scene = paper_scene();
  const double mass = scene.sphere.mass;
  const double inertia = mass * scene.sphere.gyration_radius * scene.sphere.gyration_radius;
  Simulation simulation(scene);
  for (int i = 0; i < 5; ++i) {
    for (const double part : {0.99, 1.01}) {
      scene::Wrench wrench;
      (i < 2 ? wrench.force[i] : wrench.torque[i - 2]) = -part * most * (i < 2 ? mass : inertia);
      if (part < 1) {
        EXPECT_NO_THROW(simulation.set_command(wrench)) << i;
      } else {
        EXPECT_THROW(simulation.set_command(wrench), std::invalid_argument) << i;
      }
    }
  }
}

TEST(Interventions, AnInitialStateHasAUnitQuaternionWhateverItsLengthWas) {
  for (const double length : {1.0, 2.0, 1e-200, 1e200, 1e-320}) {
    Simulation simulation(paper_scene());
    scene::InitialState state = paper_scene().initial_state;
    state.orientation = Quaterniond(length, 0, 0, 0);
    simulation.set_initial_state(state);
    EXPECT_EQ(simulation.state().orientation.coeffs(), Quaterniond::Identity().coeffs()) << length;
    simulation.advance_to(1, {});
    EXPECT_NEAR(simulation.state().orientation.norm(), 1, 64 * DBL_EPSILON) << length;
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::interventions_test
