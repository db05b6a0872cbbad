// An impulse from outside whose effects are interrupted before a ground has acted.

#include <gtest/gtest.h>

#include "hybrid_sphere/simulation/simulation.hpp"
#include "support/interrupted.hpp"
#include "support/recorded.hpp"

namespace hybrid_sphere::testing::interrupted_kick_test {
namespace {

using scene::Law;

/// Kappa = 1/5; resting or rolling on a slope, left of smooth ground.
scene::Scene on_a_slope(const scene::Material& ground) {
  scene::Scene scene{};
  scene.sphere = {2, 0.5, 0.25};
  scene.surface.base = ground;
  scene.surface.regions = {{"right", scene::HalfPlane{{0, 0}, {1, 0}}, Law::smooth}};
  scene.forces.gravity = {0.5, 0.25, -8};
  scene.initial_state.position = {-1, 0};
  return scene;
}

// Where it is interrupted, the state is that before the impulse, or that after the ground has acted.
void expect_consistent_interrupts(const scene::Scene& scene) {
  const QuestionsEvery questions(1);
  Simulation whole(scene);
  whole.advance_to(0.5, {});
  const RecordedState before(whole);
  whole.kick({1, 2});
  whole.advance_to(0.5, {});
  const RecordedState after(whole);
  whole.advance_to(20, {});
  int interrupted_before = 0;
  for (int last = 1;; ++last) {
    SCOPED_TRACE(last);
    ASSERT_LT(last, 1000);
    Simulation simulation(scene);
    simulation.advance_to(0.5, {});
    simulation.kick({1, 2});
    int asked = 0;
    simulation.set_interrupt([&] { return ++asked == last; });
    try {
      simulation.advance_to(20, {});
      break;
    } catch (const Interrupted&) {
      const RecordedState there(simulation);
      const bool has_acted = there.twist.velocity != before.twist.velocity;
      if (there.time == 0.5) expect_same(there, has_acted ? after : before);
      interrupted_before += has_acted ? 0 : 1;
    }
    simulation.advance_to(20, {});
    expect_same(RecordedState(simulation), RecordedState(whole));
  }
  EXPECT_GE(interrupted_before, 2);
}

TEST(InterruptedKick, LeavesAConsistentStateWhereItIsInterrupted) {
  expect_consistent_interrupts(on_a_slope(Law::rough));
  scene::Material holds(Law::rough);
  holds.rolling_resistance = 0.25;
  expect_consistent_interrupts(on_a_slope(holds));
}

// Another ground comes before the one in force has acted: it takes the velocities after the impulse.
TEST(InterruptedKick, IsMetByAGroundThatComesThen) {
  const QuestionsEvery questions(1);
  for (const Law law : {Law::smooth, Law::rough}) {
    for (const double slope : {0.0, 0.5}) {
      scene::Scene scene = on_a_slope(law);
      scene.forces.gravity = {slope, 0, -8};
      scene.initial_state.velocity = {0.25, 0};
      scene::Surface rough = scene.surface;
      rough.base = Law::rough;
      Simulation whole(scene);
      whole.advance_to(0.5, {});
      whole.kick({1, 2});
      whole.set_surface(rough);
      whole.advance_to(1, {});
      int interrupted = 0;
      for (int last = 1; last < 20; ++last) {
        SCOPED_TRACE(last);
        Simulation simulation(scene);
        simulation.advance_to(0.5, {});
        const Vector2d velocity = simulation.state().twist.velocity;
        simulation.kick({1, 2});
        int asked = 0;
        simulation.set_interrupt([&] { return ++asked == last; });
        EXPECT_THROW(simulation.advance_to(1, {}), Interrupted);
        if (simulation.time() != 0.5 || simulation.state().twist.velocity != velocity) break;
        ++interrupted;
        simulation.set_surface(rough);
        EXPECT_EQ(simulation.state().twist.velocity, velocity);
        simulation.advance_to(1, {});
        expect_same(RecordedState(simulation), RecordedState(whole));
      }
      EXPECT_GE(interrupted, 1);
    }
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::interrupted_kick_test
