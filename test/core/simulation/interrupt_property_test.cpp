// Wherever a computation is interrupted, it goes on as if it had not been.

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "support/interrupted.hpp"
#include "support/random_scenes.hpp"

namespace hybrid_sphere::testing::interrupt_property_test {
namespace {

RC_GTEST_PROP(Simulation, IsTheSameHoweverItIsInterrupted, ()) {
  const scene::Scene scene = random_any_scene();
  RC_LOG() << scene;
  constexpr double horizon = 8;
  const Record whole = record(scene, horizon, 8);
  int stops = 0;
  const auto one_in = static_cast<std::uint32_t>(integer(200, 2000));
  const Record parts = record_interrupted(scene, horizon, 8, 1, one_in, stops, [](Simulation& simulation) {
    const State& state = simulation.state();
    RC_ASSERT(state.position.allFinite());
    RC_ASSERT(state.twist.velocity.allFinite());
    RC_ASSERT(std::abs(state.orientation.norm() - 1) < 1e-13);
  });
  RC_CLASSIFY(stops > 0, "interrupted");
  RC_ASSERT(parts.halt == whole.halt);
  RC_ASSERT(parts.switches.size() == whole.switches.size());
  for (std::size_t i = 0; i < whole.switches.size(); ++i) {
    RC_ASSERT(parts.switches[i].time == whole.switches[i].time);
    RC_ASSERT(parts.switches[i].impulse == whole.switches[i].impulse);
    RC_ASSERT(parts.switches[i].cause == whole.switches[i].cause);
    RC_ASSERT(parts.switches[i].to == whole.switches[i].to);
  }
  RC_ASSERT(parts.states.size() == whole.states.size());
  for (std::size_t i = 0; i < whole.states.size(); ++i) {
    RC_ASSERT(parts.states[i].position == whole.states[i].position);
    RC_ASSERT(parts.states[i].orientation.coeffs() == whole.states[i].orientation.coeffs());
    RC_ASSERT(parts.states[i].twist.velocity == whole.states[i].twist.velocity);
    RC_ASSERT(parts.states[i].twist.angular_velocity == whole.states[i].twist.angular_velocity);
    RC_ASSERT(parts.states[i].mode == whole.states[i].mode);
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::interrupt_property_test
