// Whether a simulation goes on and, if not, why: the status, the exception, and what a table of states holds.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "hybrid_sphere/scene/read_scene.hpp"
#include "support/interrupted.hpp"

namespace hybrid_sphere::testing::status_test {
namespace {

scene::Scene read(const std::string& file) {
  return scene::read_scene_file(std::string(TEST_DATA_DIR) + "/" + file);
}

/// Two belts that drive a sphere at each other, with the choice to stop there.
scene::Scene livelock() {
  return scene::read_scene_text(R"(
sphere: {mass: 1, radius: 0.1, body: solid}
initial_state: {position: [-1, 0], velocity: [1, 0]}
surface:
  base: {law: smooth}
  regions:
    - {name: to_the_right, law: rough, belt: [3, 0], polygon: [[-0.5, -1], [0, -1], [0, 1], [-0.5, 1]]}
    - {name: to_the_left, law: rough, belt: [-8, 0], half_plane: {point: [0, 0], normal: [1, 0]}}
  livelock: stop
)");
}

Status status_at_the_end(Simulation& simulation, double until) {
  try {
    simulation.advance_to(until);
  } catch (const HaltedError& error) {
    const Status status = simulation.status();
    EXPECT_EQ(status.stop, error.stop());
    EXPECT_EQ(status.time, error.time());
    EXPECT_EQ(status.message, error.what());
  }
  return simulation.status();
}

TEST(Status, OfASimulationThatGoesOnIsNone) {
  Simulation simulation(livelock());
  const Status status = status_at_the_end(simulation, 0.25);
  EXPECT_EQ(status.stop, Stop::none);
  EXPECT_EQ(status.time, 0.25);
  EXPECT_EQ(status.message, "");
}

TEST(Status, OfAHaltTellsItsKind) {
  Simulation livelocked(livelock());
  EXPECT_EQ(status_at_the_end(livelocked, 10).stop, Stop::livelock);
  EXPECT_EQ(livelocked.time(), livelocked.status().time);
  livelocked.reset();
  EXPECT_EQ(livelocked.status().stop, Stop::none);

  Simulation accumulated(read("accumulation/chatter_from_rest.yaml"));
  EXPECT_EQ(status_at_the_end(accumulated, 100).stop, Stop::accumulation);

  Simulation unstable(read("halts/long_steps_of_rk4.yaml"));
  EXPECT_EQ(status_at_the_end(unstable, 1000).stop, Stop::numerical);
}

TEST(Status, OfAnInterruptionHoldsUntilTheNextCall) {
  const QuestionsEvery question(1);
  Simulation simulation(read("halts/slowest_turntable.yaml"));
  bool stops = true;
  simulation.set_interrupt([&] { return stops; });
  EXPECT_THROW(simulation.advance_to(1), Interrupted);
  EXPECT_EQ(simulation.status().stop, Stop::interrupted);
  EXPECT_EQ(simulation.status().time, simulation.time());
  stops = false;
  simulation.advance_to(simulation.time());
  EXPECT_EQ(simulation.status().stop, Stop::none) << "the same time again";
}

TEST(Simulation, TellsManyStatesInOneCall) {
  const std::vector<double> times{0, 0.25, 0.5, 0.5, 2};
  Simulation one(livelock());
  Simulation other(livelock());
  std::vector<State> states;
  one.states({0, 0.25, 0.5, 0.5}, states);
  ASSERT_EQ(states.size(), 4U);
  for (std::size_t i = 0; i < states.size(); ++i) {
    other.advance_to(times[i]);
    EXPECT_EQ(states[i].time, times[i]);
    EXPECT_EQ(states[i].position, other.state().position);
    EXPECT_EQ(states[i].orientation.coeffs(), other.state().orientation.coeffs());
  }
  // As far as it comes.
  Simulation halts(livelock());
  EXPECT_THROW(halts.states(times, states), HaltedError);
  EXPECT_EQ(states.size(), 4U);
}

}  // namespace
}  // namespace hybrid_sphere::testing::status_test
