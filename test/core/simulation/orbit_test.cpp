// Circles that a rolling sphere runs on a turntable (docs/theory.md 4.2).

#include <gtest/gtest.h>

#include <cmath>

#include "support/recorded.hpp"

namespace hybrid_sphere::testing::orbit_test {
namespace {

using scene::Law;

constexpr scene::SphereBody sphere{1, 0.5, 0.25};  // kappa = 1/5

// On a turntable with kappa W = 1 the sphere goes round the centre of its orbit at the speed of its radius.
scene::Scene orbit(double radius_of_disc) {
  scene::Scene scene{};
  scene.sphere = sphere;
  scene.surface.base.law = Law::smooth;
  scene::Material table(Law::rough);
  table.turntable_rate = 5;
  scene.surface.regions = {{"disc", scene::Circle{{0, 0}, radius_of_disc, false}, table}};
  scene.initial_state.position = {1, 0};
  scene.initial_state.velocity = {0, 1};
  scene.initial_state.angular_velocity = {8, 0, 0};  // rolls: sigma = (0, 1 + 4) = 5 J r
  return scene;
}

// The free sphere would leave the disc at once, so that the ground around it has to turn, too.
TEST(Orbit, AlongTheCircleOfItsTurntableRidesIt) {
  scene::Scene scene = orbit(1);
  scene.surface.base = scene.surface.regions[0].material;
  Simulation simulation(scene);
  simulation.advance_to(200, {});
  EXPECT_EQ(simulation.switches(), 1U);
  EXPECT_NEAR(simulation.state().position.norm(), 1, 1e-12);
}

TEST(Orbit, JustInsideTheCircleOfItsTurntableStaysThere) {
  Simulation simulation(orbit(1 + 0x1p-40));
  simulation.advance_to(200, {});
  EXPECT_EQ(simulation.switches(), 1U);
  EXPECT_EQ(simulation.state().region, "disc");
  EXPECT_NEAR(simulation.state().position.norm(), 1, 1e-12);
}

// Each piece of the path is a revolution that begins and ends on the edge, as far as rounding tells.
TEST(Orbit, FromAnEdgeCrossesItTwiceInEveryRevolution) {
  for (int i = 0; i < 200; ++i) {
    const double rate = 0.3 + 0.01 * i;  // of the orbit
    const double speed = 0.5 + 0.37 * (i % 7);
    scene::Scene scene{};
    scene.sphere = sphere;
    scene::Material table(Law::rough);
    table.turntable_rate = 5 * rate;
    scene.surface = {table, {{"right", scene::HalfPlane{{0, 0}, {1, 0}}, table}}};
    scene.initial_state.velocity = {speed, 0};
    scene.initial_state.angular_velocity = {0, 2 * speed, 0};
    Simulation simulation(scene);
    const double revolution = 2 * M_PI / rate;
    for (int n = 0; n < 5; ++n) {
      simulation.advance_to((n + 0.01) * revolution, {});
      ASSERT_EQ(simulation.state().region, "right") << rate << ' ' << n;
      simulation.advance_to((n + 0.51) * revolution, {});
      ASSERT_EQ(simulation.state().region, "base") << rate << ' ' << n;
    }
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::orbit_test
