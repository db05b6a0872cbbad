// A simulation that does not follow the orientation: everything else is the same to the bit.

#include <gtest/gtest.h>

#include <vector>

#include "support/recorded.hpp"

namespace hybrid_sphere::testing::without_orientation_test {
namespace {

using scene::Law;

scene::Scene base_scene() {
  scene::Scene scene{};
  scene.sphere = {1, 0.1, 0.063};
  scene.forces.gravity = {0.3, 0.1, -9.81};
  scene.initial_state.position = {-0.5, 0.02};
  scene.initial_state.velocity = {1, 0.1};
  scene.initial_state.angular_velocity = {3, -2, 1};
  scene.initial_state.orientation = Quaterniond(0.5, 0.5, -0.5, 0.5);
  scene.surface.regions = {{"right", scene::HalfPlane{{0, 0}, {1, 0}}, Law::rough}};
  return scene;
}

/// On level ground, by closed forms, and integrated.
std::vector<scene::Scene> scenes() {
  std::vector<scene::Scene> all(4, base_scene());
  all[0].forces.gravity = {0, 0, -9.81};
  all[2].surface.regions[0].material.turntable_rate = 2;
  all[3].surface.base = Law::coulomb;
  all[3].surface.base.friction = 0.1;
  all[3].forces.drag = {0.1, 0.01, 0.2};
  return all;
}

TEST(WithoutOrientation, AllElseIsTheSameToTheBit) {
  for (const scene::Scene& scene : scenes()) {
    Simulation with(scene);
    Simulation without(scene);
    without.follow_orientation(false);
    Switches switches[2];
    for (int i = 0; i <= 50; ++i) {
      with.advance_to(0.1 * i, recorder(switches[0]));
      without.advance_to(0.1 * i, recorder(switches[1]));
      const State& expected = with.state();
      const State& state = without.state();
      ASSERT_EQ(state.position, expected.position) << i;
      ASSERT_EQ(state.twist.velocity, expected.twist.velocity) << i;
      ASSERT_EQ(state.twist.angular_velocity, expected.twist.angular_velocity) << i;
      ASSERT_EQ(state.slip, expected.slip) << i;
      ASSERT_EQ(state.mode, expected.mode) << i;
      ASSERT_EQ(without.reaction(), with.reaction()) << i;
      EXPECT_LE((state.orientation.coeffs() - scene.initial_state.orientation.coeffs()).norm(), 1e-15) << i;
    }
    ASSERT_EQ(switches[0].size(), switches[1].size());
    ASSERT_FALSE(switches[0].empty());
    for (std::size_t i = 0; i < switches[0].size(); ++i) {
      EXPECT_EQ(switches[1][i].time, switches[0][i].time);
      EXPECT_EQ(switches[1][i].impulse, switches[0][i].impulse);
    }
  }
}

TEST(WithoutOrientation, ReturnsToTheInitialState) {
  Simulation simulation(base_scene());
  simulation.advance_to(1, {});
  const Quaterniond turned = simulation.state().orientation;
  simulation.follow_orientation(false);
  EXPECT_EQ(simulation.time(), 0);
  simulation.advance_to(1, {});
  simulation.follow_orientation(true);
  EXPECT_EQ(simulation.time(), 0);
  simulation.advance_to(1, {});
  EXPECT_EQ(simulation.state().orientation.coeffs(), turned.coeffs());
}

}  // namespace
}  // namespace hybrid_sphere::testing::without_orientation_test
