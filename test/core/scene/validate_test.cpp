#include "hybrid_sphere/scene/validate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "hybrid_sphere/scene/read_scene.hpp"

namespace hybrid_sphere::scene::validate_test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Scene plain() {
  Scene scene{};
  scene.sphere = {1, 0.5, 0.3};
  scene.surface.base = Law::rough;
  scene.surface.regions.push_back({"disc", Circle{{1, 2}, 3}, Law::smooth});
  scene.surface.regions.push_back({"yard", Polygon{{{0, 0}, {1, 0}, {0, 1}}}, Law::rubber});
  return scene;
}

std::string refusal(const std::function<void(Scene&)>& change) {
  Scene scene = plain();
  change(scene);
  try {
    validate(scene);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "taken";
}

TEST(Validate, TakesASceneThatIsOne) { EXPECT_NO_THROW(validate(plain())); }

TEST(Validate, NamesTheFieldTheValueAndTheRange) {
  EXPECT_EQ(refusal([](Scene& s) { s.sphere.mass = -1; }),
            "sphere.mass: -1 is refused; allowed: a number from 1e-60 to 1e+60 [kg]");
  EXPECT_EQ(refusal([](Scene& s) { s.sphere.mass = nan; }),
            "sphere.mass: nan is refused; allowed: a number from 1e-60 to 1e+60 [kg]");
}

TEST(Validate, RefusesEachFieldThatIsOutOfRange) {
  const std::pair<const char*, std::function<void(Scene&)>> cases[] = {
      {"sphere.radius", [](Scene& s) { s.sphere.radius = 0; }},
      {"sphere.gyration_radius", [](Scene& s) { s.sphere.gyration_radius = 0.5; }},
      {"initial_state.position[1]", [](Scene& s) { s.initial_state.position.y() = nan; }},
      {"initial_state.orientation", [](Scene& s) { s.initial_state.orientation.w() = 0.9; }},
      {"initial_state.velocity[0]", [](Scene& s) { s.initial_state.velocity.x() = 1e16; }},
      {"initial_state.angular_velocity[2]",
       [](Scene& s) { s.initial_state.angular_velocity.z() = INFINITY; }},
      {"surface.base.friction", [](Scene& s) { s.surface.base.friction = 0.1; }},
      {"surface.base.rolling_resistance", [](Scene& s) { s.surface.base.rolling_resistance = -0.1; }},
      {"surface.base.turntable",
       [](Scene& s) {
         s.surface.base.belt = {1, 0};
         s.surface.base.turntable_rate = 1;
       }},
      {"surface.regions[0].belt",
       [](Scene& s) {
         s.surface.regions[0].material.belt = {1, 0};
       }},
      {"surface.regions[0].circle.radius",
       [](Scene& s) {
         s.surface.regions[0].shape = Circle{{0, 0}, 0};
       }},
      {"surface.regions[0].half_plane.normal",
       [](Scene& s) {
         s.surface.regions[0].shape = HalfPlane{{0, 0}, {0, 0}};
       }},
      {"surface.regions[0].name", [](Scene& s) { s.surface.regions[0].name = "base"; }},
      {"surface.regions[1].name", [](Scene& s) { s.surface.regions[1].name = "disc"; }},
      {"surface.regions[1].polygon[2][0]",
       [](Scene& s) { std::get<Polygon>(s.surface.regions[1].shape).vertices[2].x() = nan; }},
      {"surface.regions[1].polygon: a list of 2",
       [](Scene& s) { std::get<Polygon>(s.surface.regions[1].shape).vertices.pop_back(); }},
      {"surface.regions[1].polygon: a clockwise order",
       [](Scene& s) {
         auto& vertices = std::get<Polygon>(s.surface.regions[1].shape).vertices;
         std::swap(vertices[0], vertices[1]);
       }},
      {"surface.regions[1].spin_friction", [](Scene& s) { s.surface.regions[1].material.spin_friction = 1; }},
      {"surface.image_regions", [](Scene& s) { s.surface.image_regions = 3; }},
      {"surface.image[0]", [](Scene& s) { s.surface.image_regions = 1; }},
      {"surface.base.law", [](Scene& s) { s.surface.base.law = static_cast<Law>(7); }},
      {"surface.livelock", [](Scene& s) { s.surface.livelock = static_cast<Livelock>(9); }},
      {"solver.method", [](Scene& s) { s.solver.method = static_cast<Solver::Method>(99); }},
      {"gravity[2]", [](Scene& s) { s.forces.gravity.z() = 1; }},
      {"wrench.force[0]", [](Scene& s) { s.forces.wrench.force.x() = 1e16; }},
      {"drag.quadratic", [](Scene& s) { s.forces.drag.quadratic = -1; }},
      {"spring.stiffness", [](Scene& s) { s.forces.spring.stiffness = nan; }},
      {"surface.base.law",
       [](Scene& s) {
         s.surface.base = Law::coulomb;
         s.forces.gravity.setZero();
       }},
      {"solver.accuracy", [](Scene& s) { s.solver.accuracy = 0; }},
      {"solver.step", [](Scene& s) { s.solver.step = nan; }},
  };
  for (const auto& [path, change] : cases) {
    EXPECT_EQ(refusal(change).rfind(path, 0), 0U) << path << " is not named first: " << refusal(change);
  }
}

TEST(Validate, TakesWhatTheReaderHasRead) {
  const Scene scene = read_scene_text(R"(
sphere: {mass: 1, radius: 1, body: shell}
initial_state: {orientation: [0, 0, 0.7, 0.71]}
surface:
  base: {law: coulomb, friction: 0.3, rolling_resistance: 0.1, turntable: {rate: 2, center: [1, 1]}}
  regions:
    - {name: clockwise, law: smooth, polygon: [[0, 0], [0, 1], [1, 1], [1, 0]]}
)");
  EXPECT_NO_THROW(validate(scene));
}

}  // namespace
}  // namespace hybrid_sphere::scene::validate_test
