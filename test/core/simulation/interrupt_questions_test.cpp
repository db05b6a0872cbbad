// How often a computation asks whether to go on.

#include <gtest/gtest.h>

#include "interrupt/interrupt.hpp"
#include "support/interrupted.hpp"

namespace hybrid_sphere::testing::interrupt_questions_test {
namespace {

using scene::Law;

/// Turns of loops that pass while the simulation does not ask whether to go on.
int turns_without_a_question(const scene::Scene& scene, double until) {
  const QuestionsEvery questions(1);
  int turns = 0;
  const ShouldStop count = [&] { return ++turns < 0; };
  const InterruptScope outside(count);
  Simulation simulation(scene);
  simulation.set_interrupt([] { return false; });
  try {
    simulation.advance_to(until, {});
  } catch (const HaltedError&) {
  }
  (void)simulation.state();
  return turns;
}

// At the end of an integrated motion of very many steps, on a slope that pulls just as friction does.
TEST(Interrupt, AsksDuringTheOrientationAtASwitch) {
  constexpr double friction = 0.28125;
  scene::Scene scene{};
  scene.sphere = {1.25, 0.625, 0.2734375};
  scene.surface.base = scene::Material(Law::coulomb);
  scene.surface.base.friction = scene.surface.base.rolling_resistance = friction;
  scene.forces.gravity = {8 * friction, 0, -8};
  scene.initial_state.velocity = {0, 0};
  scene.initial_state.angular_velocity = {0, -0.8, -6.375};
  scene.solver.method = scene::Solver::Method::arkode_erk3;
  EXPECT_LT(turns_without_a_question(scene, 8), 1000);
}

// Throws between two grounds whose limit, by the forces at the beginning, would come after hours.
TEST(Interrupt, AsksDuringTheSearchForTheLastThrow) {
  scene::Scene scene{};
  scene.sphere = {1, 1, 0.75};
  scene.surface.base = scene::Material(Law::rough);
  scene.surface.base.turntable_rate = -0.0025;
  scene::Material belt(Law::coulomb);
  belt.friction = 0.46875;
  belt.rolling_resistance = 0.15625;
  belt.belt = {-1.75, 1};
  const scene::Polygon polygon{{{1, -4}, {7, -6}, {8, 0}, {8, 1}, {-1, 8}}, true};
  scene.surface.regions = {{"belt", scene::Circle{{-4, -7}, 6, true}, belt}, {"rough", polygon, Law::rough}};
  scene.forces.drag.quadratic = 1.25;
  scene.initial_state.position = {1, -3};
  scene.initial_state.velocity = {-1, -3};
  scene.initial_state.angular_velocity = {-3.625, 2.25, 5.125};
  scene.solver.method = scene::Solver::Method::rkmk4;
  scene.solver.step = 0x1p-6;
  EXPECT_LT(turns_without_a_question(scene, 8), 1000);
}

// A belt takes the sphere back to rough ground, which throws it out again: three turns to an instant.
TEST(Interrupt, AsksItsOwnFunctionWhoeverElseCountsTurns) {
  scene::Scene scene{};
  scene.sphere = {0.25, 1, 0.75};
  scene.surface.base = scene::Material(Law::rough);
  scene::Material belt(Law::coulomb);
  belt.friction = 0.22;
  belt.belt = {-0.7, 0.2};
  scene.surface.regions = {{"belt", scene::HalfPlane{{-1.6, 1}, {1, 0}}, belt}};
  scene.initial_state.position = {-1.6, 1.6};
  scene.initial_state.velocity = {0, -1.3e-6};
  scene.initial_state.angular_velocity = {-2.5e-6, 9e-6, 0};
  const ShouldStop nobody = [] { return false; };
  const InterruptScope outside(nobody);
  Simulation simulation(scene);
  int asked = 0;
  int switches = 0;
  simulation.set_interrupt([&] { return ++asked < 0; });
  simulation.advance_to(0.01, [&](const Switch&) { ++switches; });
  ASSERT_GT(switches, 6000);
  EXPECT_GT(asked, switches / 1024);
}

}  // namespace
}  // namespace hybrid_sphere::testing::interrupt_questions_test
