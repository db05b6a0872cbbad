// What a good scene is read as. What is refused is in data/bad_scenes.

#include "scene/read_tree.hpp"

#include <gtest/gtest.h>

#include "scene/yaml.hpp"

namespace hybrid_sphere::testing::read_scene_test {
namespace {

using scene::Scene;

Scene read(const std::string& text) { return scene::read_scene(scene::tree_from_yaml(text)); }

const std::string sphere = "sphere: {mass: 2, radius: 0.5, body: solid}\n";

Scene with_region(const std::string& region) {
  return read(sphere + "surface: {regions: [{name: r, law: rough, " + region + "}]}\n");
}

TEST(Scene, HasDefaultsForAllButTheSphere) {
  const Scene scene = read(sphere);
  EXPECT_EQ(scene.initial_state.position, Vector2d::Zero());
  EXPECT_EQ(scene.initial_state.velocity, Vector2d::Zero());
  EXPECT_EQ(scene.initial_state.angular_velocity, Vector3d::Zero());
  EXPECT_EQ(scene.initial_state.orientation.coeffs(), Quaterniond::Identity().coeffs());
  EXPECT_EQ(scene.surface.base.law, scene::Law::smooth);
  EXPECT_TRUE(scene.surface.regions.empty());
  EXPECT_EQ(scene.solver.method, scene::Solver::Method::automatic);
  EXPECT_EQ(scene.solver.accuracy, 1e-9);
}

TEST(Scene, HasTheGyrationRadiusOfItsBody) {
  EXPECT_NEAR(read(sphere).sphere.gyration_radius, 0.5 * std::sqrt(0.4), 1e-16);
  const Scene shell = read("sphere: {mass: 2, radius: 0.5, body: shell}\n");
  EXPECT_NEAR(shell.sphere.gyration_radius, 0.5 * std::sqrt(2.0 / 3), 1e-16);
  EXPECT_EQ(read("sphere: {mass: 2, radius: 0.5, gyration_radius: 0.25}\n").sphere.gyration_radius, 0.25);
}

TEST(Scene, TakesAShellsGyrationRadiusTypedWithAllItsDigits) {
  const Scene scene = read("sphere: {mass: 1, radius: 3, gyration_radius: 2.4494897427831781}\n");
  EXPECT_EQ(scene.sphere.gyration_radius, 2.4494897427831781);
}

TEST(Scene, TakesTextThatIsANumber) {
  const Scene scene = read("sphere: {mass: '1e-9', radius: \"2\", body: solid}\n");
  EXPECT_EQ(scene.sphere.mass, 1e-9);
  EXPECT_EQ(scene.sphere.radius, 2);
}

TEST(Scene, MakesTheLengthOfTheOrientationOne) {
  const Scene scene = read(sphere + "initial_state: {orientation: [0.6, 0, 0, 0.801]}\n");
  EXPECT_NEAR(scene.initial_state.orientation.norm(), 1, 2.3e-16);
  EXPECT_NEAR(scene.initial_state.orientation.x() / scene.initial_state.orientation.w(), 0.6 / 0.801, 1e-15);
}

TEST(Scene, HasTheOrientationInTheOrderXYZW) {
  const Scene scene = read(sphere + "initial_state: {orientation: [0.5, -0.5, 0.5, -0.5]}\n");
  EXPECT_EQ(scene.initial_state.orientation.coeffs(), Eigen::Vector4d(0.5, -0.5, 0.5, -0.5));
}

TEST(Scene, KeepsEveryDigitOfTheInitialState) {
  const Scene scene = read(sphere +
                           "initial_state: {position: [0.1, -0.30000000000000004], velocity: [1e-9, 2],"
                           " angular_velocity: [1, 2, 3.0000000000000004]}\n");
  EXPECT_EQ(scene.initial_state.position, Vector2d(0.1, -0.30000000000000004));
  EXPECT_EQ(scene.initial_state.velocity, Vector2d(1e-9, 2));
  EXPECT_EQ(scene.initial_state.angular_velocity, Vector3d(1, 2, 3.0000000000000004));
}

TEST(Scene, TurnsClockwisePolygonsRound) {
  const Scene scene = with_region("polygon: [[0, 0], [0, 1], [2, 0]]");
  const auto& polygon = std::get<scene::Polygon>(scene.surface.regions[0].shape);
  ASSERT_EQ(polygon.vertices.size(), 3U);
  double doubled_area = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector2d& a = polygon.vertices[i];
    const Vector2d& b = polygon.vertices[(i + 1) % 3];
    doubled_area += a.x() * b.y() - a.y() * b.x();
  }
  EXPECT_EQ(doubled_area, 2);
  EXPECT_FALSE(polygon.outside);
}

TEST(Scene, HasTheOutsideOfACircleOrAPolygonWhereAskedFor) {
  EXPECT_TRUE(std::get<scene::Circle>(
                  with_region("circle: {center: [1, 2], radius: 3}, outside: true").surface.regions[0].shape)
                  .outside);
  EXPECT_TRUE(std::get<scene::Polygon>(
                  with_region("polygon: [[0, 0], [1, 0], [0, 1]], outside: true").surface.regions[0].shape)
                  .outside);
  EXPECT_FALSE(
      std::get<scene::Circle>(
          with_region("circle: {center: [1, 2], radius: 3}, outside: false").surface.regions[0].shape)
          .outside);
}

TEST(Scene, KeepsTheOrderOfTheRegions) {
  const Scene scene = read(sphere +
                           "surface:\n  base: {law: rough}\n  regions:\n"
                           "    - {name: b, half_plane: {point: [1, 2], normal: [3, 4]}, law: smooth}\n"
                           "    - {name: a, circle: {center: [5, 6], radius: 7}, law: rough}\n");
  EXPECT_EQ(scene.surface.base.law, scene::Law::rough);
  ASSERT_EQ(scene.surface.regions.size(), 2U);
  EXPECT_EQ(scene.surface.regions[0].name, "b");
  EXPECT_EQ(scene.surface.regions[0].material.law, scene::Law::smooth);
  const auto& half_plane = std::get<scene::HalfPlane>(scene.surface.regions[0].shape);
  EXPECT_EQ(half_plane.point, Vector2d(1, 2));
  EXPECT_EQ(half_plane.normal, Vector2d(3, 4));
  EXPECT_EQ(scene.surface.regions[1].name, "a");
  EXPECT_EQ(scene.surface.regions[1].material.law, scene::Law::rough);
  const auto& circle = std::get<scene::Circle>(scene.surface.regions[1].shape);
  EXPECT_EQ(circle.center, Vector2d(5, 6));
  EXPECT_EQ(circle.radius, 7);
}

TEST(Scene, HasTheMethodAndAccuracyAskedFor) {
  const Scene scene = read(sphere + "solver: {method: exact, accuracy: 1e-12}\n");
  EXPECT_EQ(scene.solver.method, scene::Solver::Method::exact);
  EXPECT_EQ(scene.solver.accuracy, 1e-12);
}

TEST(ScenePart, IsRefusedWithThePathThatItIsReadUnder) {
  try {
    scene::read_sphere(scene::tree_from_yaml("{mass: -1, radius: 1, body: solid}"), "request.sphere");
    FAIL() << "accepted";
  } catch (const scene::SceneError& error) {
    EXPECT_EQ(std::string(error.what()).rfind("request.sphere.mass: -1 is refused; allowed: ", 0), 0U)
        << error.what();
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::read_scene_test
