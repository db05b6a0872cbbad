// Another accuracy while the simulation runs.

#include <gtest/gtest.h>

#include <cmath>

#include "hybrid_sphere/simulation/simulation.hpp"

namespace hybrid_sphere::accuracy_change_test {
namespace {

const Simulation::SwitchSink ignore = [](const Switch&) {};

scene::Scene rolling_down() {
  scene::Scene scene{};
  scene.sphere = {2, 0.25, 0.25 * std::sqrt(0.4)};
  scene.initial_state.velocity = {1, -0.375};
  scene.surface.base.law = scene::Law::rough;
  scene.forces.gravity = {0.7, 0.1, -9.81};
  return scene;
}

/// v' = -c v^2 on smooth ground: v = v_0/(1 + c v_0 t).
scene::Scene slowing_down(double accuracy) {
  scene::Scene scene{};
  scene.sphere = {1, 0.25, 0.25 * std::sqrt(0.4)};
  scene.initial_state.velocity = {1, 0};
  scene.forces.drag.quadratic = 0.5;
  scene.solver.accuracy = accuracy;
  return scene;
}

TEST(AnotherAccuracy, LeavesAClosedFormAsItIs) {
  Simulation changed(rolling_down());
  Simulation same(rolling_down());
  changed.advance_to(0, ignore);  // the ground has acted: the segment has begun
  same.advance_to(0, ignore);
  for (int i = 1; i <= 100; ++i) {
    changed.set_accuracy(std::pow(10, -1 - i % 12));
    changed.advance_to(0.1 * i, ignore);
    same.advance_to(0.1 * i, ignore);
    ASSERT_EQ(changed.state().position, same.state().position) << i;
    ASSERT_EQ(changed.state().twist.velocity, same.state().twist.velocity) << i;
    ASSERT_EQ(changed.state().orientation.coeffs(), same.state().orientation.coeffs()) << i;
  }
}

TEST(AnotherAccuracy, BeforeTheStartIsThatOfTheScene) {
  Simulation changed(slowing_down(1e-3));
  changed.set_accuracy(1e-10);
  Simulation same(slowing_down(1e-10));
  changed.advance_to(3, ignore);
  same.advance_to(3, ignore);
  EXPECT_EQ(changed.state().position, same.state().position);
}

TEST(AnotherAccuracy, ActsOnAnIntegratedMotionFromThenOn) {
  Simulation simulation(slowing_down(1e-2));
  simulation.advance_to(1, ignore);
  const State before = simulation.state();
  const std::uint64_t evaluations = simulation.evaluations();
  simulation.set_accuracy(1e-12);
  simulation.advance_to(1, ignore);
  EXPECT_EQ(simulation.state().twist.velocity, before.twist.velocity);
  EXPECT_GE(simulation.evaluations(), evaluations);
  simulation.advance_to(5, ignore);
  const double speed = before.twist.velocity.x() / (1 + 0.5 * before.twist.velocity.x() * 4);
  EXPECT_NEAR(simulation.state().twist.velocity.x(), speed, 1e-12);
  EXPECT_EQ(simulation.switches(), 0U);
}

}  // namespace
}  // namespace hybrid_sphere::accuracy_change_test
