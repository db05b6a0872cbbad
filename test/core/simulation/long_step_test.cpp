// Paths of steps that are much too long: wrong as they are, every edge that they cross is met.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "hybrid_sphere/simulation/simulation.hpp"
#include "scene/read_tree.hpp"
#include "scene/yaml.hpp"

namespace hybrid_sphere::testing::long_step_test {
namespace {

// The ground is the same everywhere, and only its name tells where the sphere is: above y = height or below.
std::string two_names(const std::string& law, const std::string& velocity, double height,
                      const std::string& solver) {
  return "sphere: {mass: 1, radius: 0.5, gyration_radius: 0.25}\n"
         "initial_state: {position: [0, 0], velocity: " +
         velocity + "}\ngravity: [0, -1, -8]\nsurface:\n  base: " + law +
         "\n  regions:\n    - {name: above, half_plane: {point: [0, " + std::to_string(height) +
         "], normal: [0, 1]}, " + law.substr(1) + "\nsolver: " + solver + "\n";
}

// At so many outputs the ground told is that under the sphere.
void expect_names(const std::string& text, double height) {
  SCOPED_TRACE(text);
  Simulation simulation(scene::read_scene(scene::tree_from_yaml(text)));
  try {
    for (int i = 0; i <= 256; ++i) {
      simulation.advance_to(i * 0x1p-5, {});
      const State& state = simulation.state();
      if (std::abs(state.position.y() - height) < 1e-9) continue;
      ASSERT_EQ(state.region == "above", state.position.y() > height)
          << "at t = " << state.time << ", y = " << state.position.y();
    }
  } catch (const HaltedError&) {  // the step is too long
  }
}

// Down the slope by Euler's method in one step of 10 s the cubic is y = t^2 - t^3/10: up to 14.8 m, with no
// velocity but -t. What is known of the force, 1 m/s^2, tells neither that it rises nor that it turns round.
TEST(LongStep, ByEulersMethodMeetsTheEdgesThatItsCubicCrosses) {
  const std::string smooth = "{law: smooth}";
  for (const double height : {0.01, 1.0, 5.0, 12.0, 13.5, 14.5, 14.9, -0.01, -1.0}) {
    for (const std::string velocity : {"[0, 0]", "[4, 0]", "[4, 0.5]", "[0, 0.5]"}) {
      expect_names(two_names(smooth, velocity, height, "{method: euler, step: 10}"), height);
    }
  }
}

TEST(LongStep, OfAnyMethodOnAnyGroundMeetsTheEdgesThatItsPathCrosses) {
  const std::string grounds[] = {"{law: smooth}",
                                 "{law: rough}",
                                 "{law: coulomb, friction: 0.0625}",
                                 "{law: coulomb, friction: 0.5, rolling_resistance: 0.0625}",
                                 "{law: rough, rolling_resistance: 0.03125}",
                                 "{law: rough, turntable: {center: [1, 2], rate: 0.5}}"};
  for (const std::string method : {"euler", "rk4", "lie_midpoint"}) {
    for (const std::string step : {"0.1", "0.5", "2.5", "10"}) {
      for (const std::string& ground : grounds) {
        for (const double height : {-20.0, -5.0, -0.5, 0.25, 0.5, 1.0, 2.0, 3.5}) {
          expect_names(two_names(ground, "[1, 2]", height, "{method: " + method + ", step: " + step + "}"),
                       height);
        }
      }
    }
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::long_step_test
