// What good grounds are read as. What is refused is in data/bad_scenes.

#include <gtest/gtest.h>

#include "scene/check.hpp"
#include "scene/read_tree.hpp"
#include "scene/yaml.hpp"

namespace hybrid_sphere::testing::read_material_test {
namespace {

using scene::Law;
using scene::Material;
using scene::Surface;

Surface read(const std::string& text) { return scene::read_surface(scene::tree_from_yaml(text)); }

Material material(const std::string& keys) { return read("base: {" + keys + "}").base; }

std::string refusal(const Surface& surface, const scene::Forces& forces) {
  try {
    scene::check_pressure(surface, forces, "map");
  } catch (const scene::SceneError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Material, IsStillGroundWithoutResistancesUnlessGiven) {
  for (const char* law : {"smooth", "rough", "rubber"}) {
    const Material ground = material(std::string("law: ") + law);
    EXPECT_EQ(scene::to_string(ground.law), std::string(law));
    EXPECT_EQ(ground.friction, 0);
    EXPECT_EQ(ground.rolling_resistance, 0);
    EXPECT_EQ(ground.spin_friction, 0);
    EXPECT_EQ(ground.belt, Vector2d::Zero());
    EXPECT_EQ(ground.turntable_rate, 0);
    EXPECT_EQ(ground.turntable_center, Vector2d::Zero());
  }
}

TEST(Material, HasTheCoefficientsOfItsLaw) {
  const Material coulomb =
      material("law: coulomb, friction: 0.3, rolling_resistance: 0.02, spin_friction: 0.01");
  EXPECT_EQ(coulomb.law, Law::coulomb);
  EXPECT_EQ(coulomb.friction, 0.3);
  EXPECT_EQ(coulomb.rolling_resistance, 0.02);
  EXPECT_EQ(coulomb.spin_friction, 0.01);
  EXPECT_EQ(material("law: rubber, rolling_resistance: 0.02").rolling_resistance, 0.02);
  EXPECT_EQ(material("law: rough, spin_friction: 0.01").spin_friction, 0.01);
  EXPECT_EQ(material("law: coulomb, friction: 0").friction, 0);
}

TEST(Material, MovesAsABeltOrATurntable) {
  EXPECT_EQ(material("law: rough, belt: [0.2, -1]").belt, Vector2d(0.2, -1));
  const Material table = material("law: rubber, turntable: {rate: -3, center: [4, 5]}");
  EXPECT_EQ(table.turntable_rate, -3);
  EXPECT_EQ(table.turntable_center, Vector2d(4, 5));
}

TEST(Material, OfARegionHasTheSameKeysAsThatOfTheBase) {
  const Surface surface = read(
      "regions: [{name: r, circle: {center: [0, 0], radius: 1}, law: coulomb, friction: 0.3, belt: [1, 2]}]");
  EXPECT_EQ(surface.regions[0].material.law, Law::coulomb);
  EXPECT_EQ(surface.regions[0].material.friction, 0.3);
  EXPECT_EQ(surface.regions[0].material.belt, Vector2d(1, 2));
}

TEST(Surface, SlidesAlongTheEdgeOfALivelockUnlessToldToStop) {
  EXPECT_EQ(read("base: {law: rough}").livelock, scene::Livelock::slide);
  EXPECT_EQ(read("livelock: slide").livelock, scene::Livelock::slide);
  EXPECT_EQ(read("livelock: stop").livelock, scene::Livelock::stop);
}

TEST(Surface, IsCheckedAgainstTheForcesInForce) {
  const Surface surface = read(
      "regions: [{name: a, circle: {center: [0, 0], radius: 1}, law: rough},"
      " {name: b, circle: {center: [0, 0], radius: 1}, law: coulomb, friction: 0.3}]");
  scene::Forces forces;
  EXPECT_EQ(refusal(surface, forces), "accepted");
  forces.gravity = Vector3d(1, 0, 0);
  EXPECT_EQ(refusal(surface, forces),
            "map.regions[1].law: \"coulomb\" is refused; allowed: smooth, rough, rubber; coulomb only while "
            "gravity presses the sphere onto the ground, gravity[2] < 0; it is 0");
}

}  // namespace
}  // namespace hybrid_sphere::testing::read_material_test
