// No exception but the documented ones leaves a simulation, and its state agrees with what it has reported,
// wherever the computation ends.

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "hybrid_sphere/scene/read_scene.hpp"
#include "support/agreement.hpp"

namespace hybrid_sphere::testing {
namespace {

scene::Scene read(const std::string& name) {
  return scene::read_scene_file(std::string(TEST_DATA_DIR) + "/halts/" + name + ".yaml");
}

// Looks at every output; at a halt twice, and again after it.
void expect_agreement(const scene::Scene& scene, double until, int outputs, const std::string& name) {
  Simulation simulation(scene);
  std::vector<RecordedSwitch> switches;
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

TEST(AState, IsToldWhereStepsAreMuchTooLong) {
  expect_agreement(read("long_steps_of_rk4"), 20, 200, "long_steps_of_rk4");
  expect_agreement(read("long_steps_on_a_mat"), 10, 100, "long_steps_on_a_mat");
}

TEST(AState, AfterAHaltInTheFirstStepIsThatOfTheSwitch) {
  const scene::Scene scene = read("first_step_after_a_switch");
  expect_agreement(scene, 3, 1, "first_step_after_a_switch");
  expect_agreement(scene, 3, 1000, "first_step_after_a_switch, often");
}

TEST(ATurntable, OfADenormalRateLeavesNoExceptionBehind) {
  expect_agreement(read("denormal_turntable"), 20, 100, "denormal_turntable");
}

// By every method and steps from short to absurd, on the scenes above.
TEST(AState, AgreesWithTheSwitchesByEveryMethod) {
  using Method = scene::Solver::Method;
  for (const char* name :
       {"long_steps_of_rk4", "long_steps_on_a_mat", "first_step_after_a_switch", "denormal_turntable"}) {
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

TEST(ASink, ThatThrowsIsHeardAndTheSimulationGoesOnAfterIt) {
  const scene::Scene scene = read("first_step_after_a_switch");
  scene::Scene fine = scene;
  fine.solver = {};
  const Record whole = record(fine, 1, 1);
  ASSERT_GE(whole.switches.size(), 2U);
  Simulation simulation(fine);
  std::vector<RecordedSwitch> switches;
  const auto throwing = [&](const Switch& event) {
    switches.emplace_back(event);
    throw std::out_of_range("mine");
  };
  for (std::size_t i = 0; i < whole.switches.size(); ++i) {
    EXPECT_THROW(simulation.advance_to(1, throwing), std::out_of_range);
    ASSERT_EQ(switches.size(), i + 1);
    EXPECT_EQ(contradiction(simulation.state(), simulation.reaction(), switches), "");
  }
  simulation.advance_to(1, throwing);
  EXPECT_EQ(simulation.state().position, whole.states.back().position);
  for (std::size_t i = 0; i < switches.size(); ++i) {
    EXPECT_EQ(switches[i].index, i);
    EXPECT_EQ(switches[i].time, whole.switches[i].time);
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing
