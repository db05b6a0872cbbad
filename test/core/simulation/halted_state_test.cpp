// No exception but the documented ones leaves a simulation, and its state agrees with what it has reported,
// wherever the computation ends.

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "hybrid_sphere/scene/read_scene.hpp"
#include "scene/read_tree.hpp"
#include "scene/yaml.hpp"
#include "support/agreement.hpp"

namespace hybrid_sphere::testing::halted_state_test {
namespace {

scene::Scene read(const std::string& name) {
  return scene::read_scene_file(std::string(TEST_DATA_DIR) + "/halts/" + name + ".yaml");
}

// Looks at every output; at a halt twice, and again after it.
void expect_agreement(const scene::Scene& scene, double until, int outputs, const std::string& name) {
  Simulation simulation(scene);
  Switches switches;
  double time = 0;
  for (int i = 0; i <= outputs; ++i) {
    try {
      simulation.advance_to(until * i / outputs, recorder(switches));
    } catch (const HaltedError& error) {
      EXPECT_EQ(error.time(), simulation.time()) << name;
      EXPECT_THROW(simulation.advance_to(until, {}), HaltedError) << name;
      i = outputs;
    } catch (const std::exception& error) {
      FAIL() << name << ": " << error.what();
    }
    const State& state = simulation.state();
    EXPECT_EQ(contradiction(state, simulation.reaction(), switches), "") << name << " at " << state.time;
    EXPECT_EQ(state.time, simulation.time()) << name;
    EXPECT_GE(state.time, time) << name;
    time = state.time;
  }
  simulation.reset();
  EXPECT_EQ(simulation.state().time, 0);
  EXPECT_EQ(simulation.state().position, scene.initial_state.position);
}

TEST(HaltedState, AStateIsToldWhereStepsAreMuchTooLong) {
  expect_agreement(read("long_steps_of_rk4"), 20, 200, "long_steps_of_rk4");
  expect_agreement(read("long_steps_on_a_mat"), 10, 100, "long_steps_on_a_mat");
}

TEST(HaltedState, AStateAfterAHaltInTheFirstStepIsThatOfTheSwitch) {
  const scene::Scene scene = read("first_step_after_a_switch");
  expect_agreement(scene, 3, 1, "first_step_after_a_switch");
  expect_agreement(scene, 3, 1000, "first_step_after_a_switch, often");
}

TEST(HaltedState, AStateAfterAHaltBeforeTheGroundHasActedNamesIt) {
  scene::Scene scene = read("first_step_after_a_switch");
  scene.surface.regions.clear();
  scene.forces.drag.translational = 1e6 * scene.sphere.mass;
  scene.forces.drag.quadratic = 1;
  scene.solver.method = scene::Solver::Method::rk4;
  scene.solver.step = 1;
  Simulation simulation(scene);
  EXPECT_THROW(simulation.advance_to(1, {}), HaltedError);
  EXPECT_EQ(simulation.state().region, "base");
}

TEST(HaltedState, ATurntableOfADenormalRateIsRefused) {
  try {
    read("denormal_turntable");
    FAIL() << "it was taken";
  } catch (const scene::SceneError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("surface.regions[0].turntable.rate: -4.94066e-324 is refused; "
                        "allowed: 0, or a number of at least 1e-60 in magnitude [rad/s]"),
              std::string::npos)
        << error.what();
  }
}

TEST(HaltedState, ATurntableOfTheLeastRateLeavesNoExceptionBehind) {
  expect_agreement(read("slowest_turntable"), 20, 100, "slowest_turntable");
}

// By every method and steps from short to absurd, on the scenes above.
TEST(HaltedState, AStateAgreesWithTheSwitchesByEveryMethod) {
  using Method = scene::Solver::Method;
  for (const char* name :
       {"long_steps_of_rk4", "long_steps_on_a_mat", "first_step_after_a_switch", "slowest_turntable"}) {
    scene::Scene scene = read(name);
    for (const Method method : {Method::rk4, Method::euler, Method::lie_midpoint, Method::rkmk4}) {
      scene.solver.method = method;
      for (const double step : {1e-2, 0.3, 10.0, 1e6}) {
        scene.solver.step = step;
        expect_agreement(scene, 5, 20, name + std::string(" ") + std::to_string(step));
      }
    }
    for (const Method method : {Method::automatic, Method::dopri5, Method::cvode_bdf}) {
      scene.solver.method = method;
      scene.solver.accuracy = 1e-5;
      expect_agreement(scene, 5, 20, name);
    }
  }
}

// From rough ground, slowly, onto a fast belt: the slip there is a thousand times what turns the sphere, and
// so is the rounding of what is computed from it.
std::string slow_on_a_fast_belt(const std::string& method, const std::string& resistance) {
  return "sphere: {mass: 0.25, radius: 0.125, gyration_radius: 0.0078125}\n"
         "initial_state: {position: [-0.0005, 0], velocity: [0.001, 0.0003],\n"
         "                angular_velocity: [-0.0024, 0.008, 0.1]}\n"
         "surface:\n"
         "  base: {law: rough}\n"
         "  regions:\n"
         "    - {name: fast, half_plane: {point: [0, 0], normal: [1, 0]}, law: coulomb, friction: 0.03125,\n"
         "       belt: [0.3, -1.7], rolling_resistance: " +
         resistance + "}\nsolver: {method: " + method + ", accuracy: 0.001, step: 0.01}\n";
}

TEST(HaltedState, AStateAtTheInstantOfASwitchIsTheOneAfterItToTheBit) {
  for (const std::string method : {"auto", "euler", "rk4", "lie_midpoint", "rkmk4", "dopri5", "cvode_bdf"}) {
    for (const std::string resistance : {"0", "0.015625"}) {
      SCOPED_TRACE(method + ", rolling_resistance " + resistance);
      const scene::Scene scene =
          scene::read_scene(scene::tree_from_yaml(slow_on_a_fast_belt(method, resistance)));
      Simulation simulation(scene);
      Switches switches;
      simulation.advance_to(0.505, recorder(switches));
      ASSERT_EQ(switches.size(), 2U);
      const RecordedSwitch left = switches[1];
      EXPECT_EQ(left.kind, SwitchKind::released);
      simulation.reset();
      simulation.advance_to(left.time, {});
      const RecordedState state(simulation);
      EXPECT_EQ(state.time, left.time);
      EXPECT_EQ(state.position, left.position);
      EXPECT_EQ(state.twist.velocity, left.after.velocity);
      EXPECT_EQ(state.twist.angular_velocity, left.after.angular_velocity);
      // And it is the one before whatever comes at that instant.
      simulation.set_surface({scene::Law::rubber, {}});
      simulation.advance_to(left.time, recorder(switches));
      ASSERT_EQ(switches.size(), 3U);
      EXPECT_EQ(switches[2].before.velocity, left.after.velocity);
      EXPECT_EQ(switches[2].before.angular_velocity, left.after.angular_velocity);
    }
  }
}

// A belt aside, ground with friction, and a belt that throws the sphere back at once.
scene::Scene profile() {
  scene::Scene scene{};
  scene.sphere = {1, 0.25, 0.125};
  scene.forces.gravity = {0, 0, -9.81};
  scene.initial_state.position = {-1, 0};
  scene.initial_state.velocity = {2, 0};
  scene::Material aside(scene::Law::rough);
  aside.belt = {0, 1};
  scene::Material dry(scene::Law::coulomb);
  dry.friction = 0.5;
  scene::Material against(scene::Law::rough);
  against.belt = {-20, 0};
  scene.surface.regions = {{"dry", scene::HalfPlane{{2, 0}, {1, 0}}, dry},
                           {"aside", scene::Polygon{{{0, -9}, {1, -9}, {1, 9}, {0, 9}}}, aside},
                           {"against", scene::HalfPlane{{3, 0}, {1, 0}}, against}};
  return scene;
}

void expect_to_go_on(const scene::Scene& scene, double until) {
  const Record whole = record(scene, until, 1);
  ASSERT_EQ(whole.halt, "");
  ASSERT_GE(whole.switches.size(), 2U);
  Simulation simulation(scene);
  Switches switches;
  const auto throwing = [&](const Switch& event) {
    switches.emplace_back(event);
    throw std::out_of_range("mine");
  };
  for (std::size_t i = 0; i < whole.switches.size(); ++i) {
    EXPECT_THROW(simulation.advance_to(until, throwing), std::out_of_range);
    ASSERT_EQ(switches.size(), i + 1);
    EXPECT_EQ(contradiction(simulation.state(), simulation.reaction(), switches), "");
  }
  simulation.advance_to(until, throwing);
  EXPECT_EQ(simulation.state().position, whole.states.back().position);
  for (std::size_t i = 0; i < switches.size(); ++i) {
    EXPECT_EQ(switches[i].index, i);
    EXPECT_EQ(switches[i].time, whole.switches[i].time);
  }
}

TEST(HaltedState, ASinkThatThrowsIsHeardAndTheSimulationGoesOnAfterIt) {
  expect_to_go_on(profile(), 5);
  scene::Scene thrown_at_once = read("first_step_after_a_switch");
  thrown_at_once.solver = {};
  expect_to_go_on(thrown_at_once, 0.0625);  // a livelock follows at 0.09 s
}

}  // namespace
}  // namespace hybrid_sphere::testing::halted_state_test
