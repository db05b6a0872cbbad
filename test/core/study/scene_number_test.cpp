// Numbers of a scene by their paths, and with which words other paths are refused.

#include "scene/scene_number.hpp"

#include <gtest/gtest.h>

#include "core/study/scene_paths.hpp"
#include "scene/read_tree.hpp"
#include "support/scene_numbers.hpp"

namespace hybrid_sphere::testing::scene_number_test {
namespace {

TEST(SceneNumber, HasAnIndexInPlaceOfARegionsName) {
  scene::Scene scene = scene::read_scene(scene::tree_from_yaml(rich_scene));
  const scene::Tree tree = scene::tree_from_yaml(rich_scene);
  const auto data_at = [&](const std::string& path) {
    const scene::SceneNumber number = scene::find_number(scene, tree, path, "vary");
    return number.field->data + number.index;
  };
  EXPECT_EQ(data_at("surface.regions[1].friction"), data_at("surface.regions[disc].friction"));
  EXPECT_EQ(data_at("surface.regions[2].circle.radius"),
            data_at("surface.regions[odd.name[3]].circle.radius"));
  EXPECT_EQ(data_at("surface.regions[0].belt[1]"), &scene.surface.regions[0].material.belt.y());
}

TEST(SceneNumber, TakesTheNameOfARegionBeforeItsIndex) {
  const std::string yaml =
      "{sphere: {mass: 1, radius: 1, body: solid}, surface: {regions: [{name: '1', law: coulomb, friction: "
      "1, circle: "
      "{center: [0, 0], radius: 1}}, {name: '0', law: rough, circle: {center: [0, 0], radius: 1}}]}}";
  EXPECT_EQ(refusal(yaml, "surface.regions[1].friction"), "accepted");
  EXPECT_NE(refusal(yaml, "surface.regions[0].friction"), "accepted");
}

TEST(SceneNumber, TakesTheLongestNameThatFits) {
  const std::string yaml =
      "{sphere: {mass: 1, radius: 1, body: solid}, surface: {regions: [{name: a, law: rough, circle: "
      "{center: [0, 0], "
      "radius: 1}}, {name: 'a].b[c', law: coulomb, friction: 1, circle: {center: [0, 0], radius: 1}}]}}";
  EXPECT_EQ(refusal(yaml, "surface.regions[a].circle.radius"), "accepted");
  EXPECT_EQ(refusal(yaml, "surface.regions[a].b[c].friction"), "accepted");
}

TEST(SceneNumber, CountsListedRegionsFromZeroAlsoBesideAnImage) {
  const std::string yaml =
      "{sphere: {mass: 1, radius: 1, body: solid}, surface: {image: {file: ice_patches.png, resolution: 0.1, "
      "origin: "
      "[0, 0], rough_above: 0.5, law: rough}, regions: [{name: mat, law: rough, circle: {center: [0, 0], "
      "radius: 1}}]}}";
  Study study = study_of(yaml, {"surface.regions[0].circle.radius"});
  study.scene_directory = std::string(TEST_DATA_DIR) + "/../../config";
  SceneVariation variation = variation_of(study);
  const double radius = 3;
  variation.set(&radius);
  EXPECT_EQ(numbers_of(variation.scene()), numbers_of(scene_of(study, variation.tree_of(&radius))));
  study.variables[0].path = "surface.image.resolution";
  SceneVariation coarser = variation_of(study);
  coarser.set(&radius);
  EXPECT_EQ(numbers_of(coarser.scene()), numbers_of(scene_of(study, coarser.tree_of(&radius))));
}

TEST(SceneNumber, IsRefusedWithTheNearestPath) {
  const auto expect_nearest = [](const std::string& path, const std::string& near) {
    EXPECT_EQ(refusal(rich_scene, path), "vary." + path + ": \"" + path +
                                             "\" is refused; allowed: the path of a number in the scene; the "
                                             "nearest one is " +
                                             near);
  };
  expect_nearest("sphere.mas", "sphere.mass");
  expect_nearest("initial_state.velocity", "initial_state.velocity[0]");
  expect_nearest("initial_state.velocity[2]", "initial_state.velocity[0]");
  expect_nearest("gravty[2]", "gravity[2]");
  expect_nearest("surface.base.frictoin", "surface.base.friction");
  expect_nearest("surface.base.turntable.rate", "surface.base.belt[0]");
  expect_nearest("surface.regions[patch].friction", "surface.base.friction");
  expect_nearest("surface.regions[1].circle.radios", "surface.regions[1].circle.radius");
  expect_nearest("", "gravity[0]");
}

TEST(SceneNumber, IsRefusedWhereAPathIsNotWrittenAsOne) {
  for (const char* path : {".sphere.mass",
                           "sphere..mass",
                           "sphere.mass.",
                           "gravity[00]",
                           "gravity[0",
                           "gravity[+0]",
                           "gravity[-1]",
                           "gravity[]",
                           "gravity.[0]",
                           "gravity[0]x",
                           "gravity[18446744073709551616]",
                           "surface.regions[0]friction",
                           "surface.regions[disc]friction",
                           "surface.regions[disc]",
                           "surface.regions[01].friction",
                           "surface.regions[disc",
                           "surface.regions[]",
                           "surface.regions[",
                           "surface.regions",
                           "surface[0]",
                           "sphere",
                           "initial_state.orientation[4]",
                           "initial_state.orientation",
                           "surface.regions[patch].polygon[4][0]",
                           "surface.regions[patch].polygon[0]",
                           "surface.regions[patch].polygon[0][2]",
                           "surface.regions[patch].name",
                           "surface.regions[odd.name[3]].outside",
                           "surface.livelock",
                           "sphere.mass[0]"}) {
    EXPECT_NE(refusal(rich_scene, path), "accepted") << path;
  }
}

TEST(SceneNumber, IsRefusedInARegionThatIsNotThere) {
  EXPECT_EQ(
      refusal(rich_scene, "surface.regions[dics].friction"),
      "vary.surface.regions[dics].friction: region \"dics\" is refused; allowed: the name of a region of the "
      "scene; the nearest one is \"disc\"");
  EXPECT_EQ(refusal(rich_scene, "surface.regions[5].friction").find("region \"5\" is refused"),
            std::string("vary.surface.regions[5].friction: ").size());
  EXPECT_EQ(refusal("sphere: {mass: 1, radius: 1, body: solid}", "surface.regions[0].friction"),
            "vary.surface.regions[0].friction: region \"0\" is refused; allowed: a scene with regions that "
            "have names");
}

TEST(SceneNumber, IsRefusedWhereAFileMayNotGiveItBesideOthers) {
  EXPECT_EQ(refusal(poor_scene, "sphere.gyration_radius"),
            "sphere.body: \"solid\" together with gyration_radius is refused; allowed: exactly one of body "
            "(solid, shell) "
            "and gyration_radius");
  EXPECT_EQ(refusal(poor_scene, "spring.center[0]"),
            "spring.stiffness: is missing; allowed: a number from 0 to 2e+15 [N/m] (1e15 m)");
  EXPECT_EQ(refusal(poor_scene, "surface.regions[spun].belt[0]").rfind("surface.regions[0].turntable: ", 0),
            0U);
}

TEST(SceneNumber, IsRefusedBesideOthersAlsoIfEverySampleWouldBeRefused) {
  Study study = study_of(poor_scene, {"spring.center[0]", "surface.base.rolling_resistance"});
  study.variables[1].distribution = Triangular{-1, -0.5, 1};
  EXPECT_THROW(variation_of(study), scene::SceneError);
}

TEST(SceneNumber, IsRefusedTheSecondTime) {
  const auto refusal_of = [](const std::vector<std::string>& paths) -> std::string {
    try {
      const Study study = study_of(rich_scene, paths);
      SceneVariation variation = variation_of(study);
    } catch (const scene::SceneError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal_of({"surface.regions[disc].friction", "sphere.mass", "surface.regions[1].friction"}),
            "vary.surface.regions[1].friction: the number of surface.regions[disc].friction is refused; "
            "allowed: each "
            "number once");
  EXPECT_NE(refusal_of({"surface.regions[patch].polygon[0][0]", "surface.regions[3].polygon[0][0]"}),
            "accepted");
  EXPECT_EQ(refusal_of(
                {"gravity[0]", "gravity[1]", "initial_state.orientation[0]", "initial_state.orientation[1]"}),
            "accepted");
}

TEST(SceneNumber, HasTheUnitOfItsRange) {
  scene::Scene scene = scene::read_scene(scene::tree_from_yaml(rich_scene));
  const auto unit_at = [&](const std::string& path) {
    return scene::unit_of(
        scene::find_number(scene, scene::tree_from_yaml(rich_scene), path, "vary").field->range);
  };
  EXPECT_EQ(unit_at("sphere.gyration_radius"), "m");
  EXPECT_EQ(unit_at("wrench.torque[1]"), "N m");
  EXPECT_EQ(unit_at("surface.base.friction"), "");
  EXPECT_EQ(unit_at("gravity[2]"), "m/s^2");
  EXPECT_EQ(unit_at("initial_state.angular_velocity[0]"), "rad/s");
}

}  // namespace
}  // namespace hybrid_sphere::testing::scene_number_test
