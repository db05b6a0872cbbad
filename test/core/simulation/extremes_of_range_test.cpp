// Where numbers end: times and speeds that are refused, motions that leave the range or cannot be followed.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "hybrid_sphere/simulation/simulation.hpp"
#include "support/interrupted.hpp"
#include "support/recorded.hpp"

namespace hybrid_sphere::testing::extremes_of_range_test {
namespace {

const Simulation::SwitchSink ignore = [](const Switch&) {};

scene::Scene rolling_east() {
  scene::Scene scene{};
  scene.sphere = {1, 0.25, 0.1};
  scene.initial_state.velocity = {1, 0};
  return scene;
}

void expect_numbers(Simulation& simulation) {
  const State& state = simulation.state();
  EXPECT_TRUE(state.position.allFinite()) << state.position.transpose();
  EXPECT_TRUE(state.orientation.coeffs().allFinite());
  EXPECT_NEAR(state.orientation.norm(), 1, 1e-15);  // a few roundings
  EXPECT_TRUE(state.twist.velocity.allFinite()) << state.twist.velocity.transpose();
  EXPECT_TRUE(state.twist.angular_velocity.allFinite()) << state.twist.angular_velocity.transpose();
  EXPECT_TRUE(state.slip.allFinite()) << state.slip.transpose();
  EXPECT_TRUE(simulation.reaction().allFinite()) << simulation.reaction().transpose();
  EXPECT_TRUE(std::isfinite(simulation.sphere().kinetic_energy(state.twist)));
}

TEST(ExtremesOfRange, ATimePastTheRangeIsRefusedAndChangesNothing) {
  Simulation simulation(rolling_east());
  simulation.advance_to(2, ignore);
  for (const double time : {1.1e15, 1e300, std::numeric_limits<double>::infinity(), std::nan("")}) {
    try {
      simulation.advance_to(time, ignore);
      ADD_FAILURE() << time << " is not refused";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("allowed: a number from 2 to "), std::string::npos)
          << error.what();
    }
    EXPECT_EQ(simulation.time(), 2);
    EXPECT_EQ(simulation.state().position.x(), 2);
  }
}

// The greatest numbers that a scene allows, each by itself.
TEST(ExtremesOfRange, TheGreatestNumbersGiveNumbersUntilTheLatestTime) {
  std::vector<scene::Scene> scenes(8, rolling_east());
  for (scene::Scene& scene : scenes) {
    scene.initial_state = {{1e15, -1e15}, Quaterniond::Identity(), {1e15, 1e15}, {1e15, 1e15, -1e15}};
  }
  scenes[1].surface.base.law = scene::Law::rough;
  scenes[2].surface.base.law = scene::Law::rubber;
  scenes[3].surface.base = scene::Law::rough;
  scenes[3].surface.base.belt = {1e15, -1e15};
  scenes[4].forces.gravity = {1e15, 1e15, -1e15};
  scenes[5].forces.drag = {1e15, 1e15, 0};
  scenes[6].surface.base = scene::Law::rough;
  scenes[6].initial_state = rolling_east().initial_state;  // the orientation costs what the angle turned does
  scenes[6].surface.base.turntable_rate = 1e15;
  scenes[7].sphere = {1e60, 1e12, 1e3};
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    SCOPED_TRACE(i);
    Simulation simulation(scenes[i]);
    for (const double time : {0.0, 1.0, 1e8, 1e15}) {
      simulation.advance_to(time, ignore);
      expect_numbers(simulation);
    }
  }
}

// Where drag of the spin holds the sphere to a turntable it is thrown outwards, the faster the farther.
scene::Scene thrown_outwards() {
  scene::Scene scene = rolling_east();
  scene.surface.base.law = scene::Law::rough;
  scene.surface.base.turntable_rate = 5;
  scene.forces.drag.rotational = 0.1;
  return scene;
}

TEST(ExtremesOfRange, AMotionThatGrowsWithoutBoundHaltsBeforeItsNumbersEnd) {
  for (const auto method : {scene::Solver::Method::automatic, scene::Solver::Method::rk4}) {
    scene::Scene scene = thrown_outwards();
    scene.solver.method = method;
    Simulation simulation(scene);
    EXPECT_THROW(simulation.advance_to(1e6, ignore), HaltedError);
    EXPECT_GT(simulation.time(), 1);
    EXPECT_LT(simulation.time(), 1e6);
    // Not the orientation: that costs what the angle turned does.
    EXPECT_TRUE(simulation.reaction().allFinite()) << simulation.reaction().transpose();
    EXPECT_THROW(simulation.advance_to(1e6, ignore), HaltedError);
  }
}

TEST(ExtremesOfRange, AMotionThatGrowsWithoutBoundHaltsAtTheSameTimeHoweverItIsLookedAt) {
  Simulation at_once(thrown_outwards());
  EXPECT_THROW(at_once.advance_to(1e6, ignore), HaltedError);
  Simulation bit_by_bit(thrown_outwards());
  try {
    for (double time = 0; time < 1e6; time += 10) {
      bit_by_bit.advance_to(time, ignore);
      EXPECT_TRUE(bit_by_bit.reaction().allFinite()) << time;
    }
    ADD_FAILURE() << "no halt";
  } catch (const HaltedError& error) {
    EXPECT_EQ(error.time(), at_once.time());
  }
}

// A fixed step of ten times what Euler's method bears.
scene::Scene unstable() {
  scene::Scene scene = rolling_east();
  scene.solver.method = scene::Solver::Method::euler;
  scene.solver.step = 0.01;
  scene.forces.drag.translational = 2000;
  return scene;
}

// Euler's method lets an oscillation grow: the errors of its steps add up to the motion in half a second.
TEST(ExtremesOfRange, AMotionThatCannotBeIntegratedFurtherHaltsAndKeepsItsLastState) {
  scene::Scene scene = rolling_east();
  scene.initial_state.angular_velocity.setZero();
  scene.solver = {scene::Solver::Method::euler, 1e-9, 0.04};
  scene.forces.spring.stiffness = 80 * scene.sphere.mass;
  Simulation simulation(scene);
  simulation.advance_to(0.1, ignore);
  EXPECT_THROW(
      {
        simulation.advance_to(2, ignore);
        simulation.state();
      },
      HaltedError);
  EXPECT_GT(simulation.time(), 0.1);
  const State halted = simulation.state();
  expect_numbers(simulation);
  EXPECT_EQ(halted.time, simulation.time());
  EXPECT_THROW(simulation.advance_to(simulation.time(), ignore), HaltedError);
  EXPECT_EQ(simulation.state().position, halted.position);
}

TEST(ExtremesOfRange, AMotionThatCannotBeIntegratedAtAllHaltsInTheFirstAdvance) {
  scene::Scene scene = unstable();
  scene.forces.drag.translational = 1e300;
  Simulation simulation(scene);
  EXPECT_EQ(simulation.state().twist.velocity, Vector2d(1, 0));
  EXPECT_THROW(simulation.advance_to(1, ignore), HaltedError);
  EXPECT_EQ(simulation.state().twist.velocity, Vector2d(1, 0));
  EXPECT_EQ(simulation.time(), 0);
}

template <class Function>
void expect_refusal(const Function& function) {
  try {
    function();
    ADD_FAILURE() << "not refused";
  } catch (const std::invalid_argument& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("solver.method: exact is refused; allowed: auto"), std::string::npos) << what;
  }
}

TEST(ExtremesOfRange, AMotionWithoutClosedFormIsRefusedByTheMethodExact) {
  scene::Scene scene = rolling_east();
  scene.solver.method = scene::Solver::Method::exact;
  scene.forces.drag.quadratic = 1;
  expect_refusal([&] { Simulation simulation(scene); });
}

TEST(ExtremesOfRange, AGroundThatLeavesNoClosedFormIsRefusedByTheMethodExactAndChangesNothing) {
  scene::Scene scene = rolling_east();
  scene.solver.method = scene::Solver::Method::exact;
  scene.forces.drag.translational = 1;
  Simulation simulation(scene);
  simulation.advance_to(1, ignore);
  scene::Surface coulomb;
  coulomb.base.law = scene::Law::coulomb;
  coulomb.base.friction = 0.1;
  expect_refusal([&] { simulation.set_surface(coulomb); });
  EXPECT_NO_THROW(simulation.advance_to(2, ignore));
  EXPECT_EQ(simulation.surface().base.law, scene::Law::smooth);
  EXPECT_EQ(simulation.evaluations(), 0U);
}

TEST(SlidingAgainstARollingResistance, IsRefusedByTheMethodExact) {
  scene::Scene scene = rolling_east();
  scene.solver.method = scene::Solver::Method::exact;
  scene.surface.base.law = scene::Law::coulomb;
  scene.surface.base.friction = 0.5;
  scene.surface.base.rolling_resistance = 0.01;
  expect_refusal([&] { Simulation simulation(scene); });
}

// What has a closed form without a force has one under a constant force.
TEST(ExtremesOfRange, ACommandLeavesTheMethodExactItsClosedForms) {
  for (const scene::Law law : {scene::Law::coulomb, scene::Law::rough}) {
    scene::Scene scene = rolling_east();
    scene.solver.method = scene::Solver::Method::exact;
    scene.surface.base.law = law;
    if (law == scene::Law::coulomb) scene.surface.base.friction = 0.5;
    if (law == scene::Law::rough) scene.surface.base.rolling_resistance = 0.01;
    Simulation simulation(scene);
    simulation.advance_to(0.1, ignore);
    const double before = simulation.state().twist.velocity.y();
    EXPECT_NO_THROW(simulation.set_command({{0, 4}, {0, 0, 0}}));
    EXPECT_NO_THROW(simulation.advance_to(1, ignore));
    EXPECT_GT(simulation.state().twist.velocity.y(), before);
    EXPECT_EQ(simulation.evaluations(), 0U);
  }
}

// The search must not repeat for each of the 1e11 revolutions: the number of loop turns is bounded.
TEST(ExtremesOfRange, ACircleThatMeetsNothingIsFollowedForOneRevolution) {
  scene::Scene scene = rolling_east();
  scene.surface.base.law = scene::Law::rough;
  scene.surface.base.turntable_rate = 20;
  for (const bool with_regions : {false, true}) {
    if (with_regions) {
      scene.surface.regions = {{"far", scene::HalfPlane{{100, 0}, {1, 0}}, scene::Law::smooth},
                               {"disc", scene::Circle{{50, 50}, 1}, scene::Law::smooth}};
    }
    Simulation simulation(scene);
    EXPECT_LT(count_turns(simulation, 1e11), 100U) << with_regions;
    expect_numbers(simulation);
  }
}

// The time in which the force would turn it back is no measure of the time in which it crosses the disc.
TEST(ExtremesOfRange, APathThatHardlyBendsLeavesTheDiscThatItHasEntered) {
  scene::Scene scene = rolling_east();
  scene.initial_state.position = {-4, -0.5};
  scene.initial_state.velocity = {1, 0.125};
  scene.surface.regions.push_back({"disc", scene::Circle{{0, 0}, 2, false}, scene::Law::rough});
  const Record straight = record(scene, 16, 1);
  ASSERT_EQ(straight.switches.size(), 2U);
  for (const double force : {1e-12, 1e-20, 1e-30, 1e-40, 1e-50, 1e-58}) {
    scene.forces.wrench.force = {-force, 0};
    const Record run = record(scene, 16, 1);
    ASSERT_EQ(run.switches.size(), 2U) << force;
    EXPECT_NEAR(run.switches[1].time, straight.switches[1].time, 1e-9) << force;
  }
}

// In the time until the edge the ground turns the path by less than rate x time: 3 rate s, in metres and
// seconds alike.
TEST(ExtremesOfRange, ATurntableThatHardlyTurnsIsGroundAtRest) {
  for (const double rate : {1e-6, 1e-9, 1e-12, 1e-15, 1e-20, 1e-30, 1e-60}) {
    scene::Scene scene{};
    scene.sphere = {1, 0.1, 0.1 * std::sqrt(0.4)};
    scene.initial_state.position = {-1.3, 0.2};
    scene.initial_state.velocity = {1, 0.3};
    scene.initial_state.angular_velocity = {-3, 10, 0};
    scene.surface.base = scene::Law::rough;
    scene.surface.base.turntable_rate = rate;
    scene.surface.regions = {{"half", scene::HalfPlane{{0, 0}, {1, 0}}, scene::Law::smooth}};
    Simulation simulation(scene);
    Switches switches;
    simulation.advance_to(3, recorder(switches));
    ASSERT_EQ(switches.size(), 2U) << rate;
    EXPECT_EQ(switches[1].kind, SwitchKind::released);
    EXPECT_NEAR(switches[1].time, 1.3, 3 * rate + 1e-15) << rate;
    EXPECT_NEAR(switches[1].position.y(), 0.59, 3 * rate + 1e-15) << rate;
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::extremes_of_range_test
