// What good forces are read as. What is refused is in data/bad_scenes.

#include <gtest/gtest.h>

#include "scene/read_tree.hpp"
#include "scene/yaml.hpp"

namespace hybrid_sphere::testing::read_forces_test {
namespace {

using scene::Forces;

Forces read(const std::string& text, const std::string& sphere = "{mass: 2, radius: 0.5, body: solid}") {
  return scene::read_scene(scene::tree_from_yaml("sphere: " + sphere + "\n" + text)).forces;
}

TEST(Forces, AreGravityAloneByDefault) {
  const Forces forces = read("");
  EXPECT_EQ(forces.gravity, Vector3d(0, 0, -9.81));
  EXPECT_EQ(forces.wrench.force, Vector2d::Zero());
  EXPECT_EQ(forces.wrench.torque, Vector3d::Zero());
  EXPECT_EQ(forces.drag.translational, 0);
  EXPECT_EQ(forces.drag.rotational, 0);
  EXPECT_EQ(forces.drag.quadratic, 0);
  EXPECT_EQ(forces.spring.stiffness, 0);
}

TEST(Forces, KeepEveryDigitOfWhatWasGiven) {
  const Forces forces = read(
      "gravity: [0.1, -0.30000000000000004, -3]\n"
      "wrench: {force: [4, 5], torque: [6, 7, 8]}\n"
      "drag: {translational: 9, rotational: 10, quadratic: 1e-3}\n"
      "spring: {center: [12, 13], stiffness: 14}\n");
  EXPECT_EQ(forces.gravity, Vector3d(0.1, -0.30000000000000004, -3));
  EXPECT_EQ(forces.wrench.force, Vector2d(4, 5));
  EXPECT_EQ(forces.wrench.torque, Vector3d(6, 7, 8));
  EXPECT_EQ(forces.drag.translational, 9);
  EXPECT_EQ(forces.drag.rotational, 10);
  EXPECT_EQ(forces.drag.quadratic, 1e-3);
  EXPECT_EQ(forces.spring.center, Vector2d(12, 13));
  EXPECT_EQ(forces.spring.stiffness, 14);
}

TEST(Forces, MayLackAPartOfEach) {
  EXPECT_EQ(read("wrench: {torque: [0, 0, 1]}\n").wrench.force, Vector2d::Zero());
  EXPECT_EQ(read("drag: {quadratic: 1}\n").drag.translational, 0);
  EXPECT_EQ(read("spring: {stiffness: 1}\n").spring.center, Vector2d::Zero());
}

TEST(Forces, MayBeWithoutGravityWhereNoFrictionNeedsIt) {
  const Forces forces = read(
      "gravity: [0, 0, 0]\n"
      "surface:\n  base: {law: rubber, rolling_resistance: 0}\n"
      "  regions: [{name: r, circle: {center: [0, 0], radius: 1}, law: rough, spin_friction: 0}]\n");
  EXPECT_EQ(forces.gravity, Vector3d::Zero());
}

TEST(Forces, AreBoundedByTheSphereThatTheyAct) {
  const std::string heavy = "{mass: 1.0e30, radius: 1.0e6, body: solid}";
  EXPECT_EQ(read("wrench: {force: [1.0e30, 0], torque: [0, 0, 1.0e50]}\n", heavy).wrench.force.x(), 1e30);
  EXPECT_THROW(read("wrench: {force: [1.0e30, 0]}\n"), scene::SceneError);
}

TEST(Wrench, IsReadUnderThePathOfACommand) {
  const scene::SphereBody sphere{1, 1, 0.5};
  const scene::Tree good = scene::tree_from_yaml("{force: [1, 2], torque: [3, 4, 5]}");
  EXPECT_EQ(scene::read_wrench(good, sphere).torque, Vector3d(3, 4, 5));
  try {
    scene::read_wrench(scene::tree_from_yaml("{force: [.nan, 2]}"), sphere, "cmd_wrench");
    FAIL() << "accepted";
  } catch (const scene::SceneError& error) {
    EXPECT_EQ(std::string(error.what()).rfind("cmd_wrench.force[0]: nan is refused; allowed: ", 0), 0U)
        << error.what();
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::read_forces_test
