// What good images are read as. What is refused is in data/bad_scenes.

#include <gtest/gtest.h>

#include <filesystem>

#include "hybrid_sphere/scene/read_scene.hpp"
#include "scene/read_tree.hpp"
#include "scene/yaml.hpp"
#include "support/temporary_file.hpp"

namespace hybrid_sphere::testing::read_image_test {
namespace {

using scene::Law;
using scene::Surface;

const std::string images = std::string(TEST_DATA_DIR) + "/images";

Surface read(const std::string& text, const std::string& directory = images) {
  return scene::read_surface(scene::tree_from_yaml(text), "surface", directory);
}

const std::vector<Vector2d>& corners(const scene::Region& region) {
  return std::get<scene::Polygon>(region.shape).vertices;
}

void expect_rectangle(const scene::Region& region, const Vector2d& low, const Vector2d& high) {
  EXPECT_EQ(corners(region)[0], low) << region.name;
  EXPECT_EQ(corners(region)[2], high) << region.name;
}

std::size_t rectangles(const std::string& keys) {
  return read("image: {resolution: 1, origin: [0, 0], " + keys + "}").regions.size();
}

TEST(ImageMap, HasItsFirstRowOnTopAndItsOriginInTheLowerLeftCorner) {
  const Surface surface =
      read("image: {file: corner.pgm, resolution: 0.5, origin: [10, 20], rough_above: 0.5}");
  ASSERT_EQ(surface.regions.size(), 2U);
  EXPECT_EQ(surface.image_regions, 2U);
  expect_rectangle(surface.regions[0], {10, 20}, {11.5, 20.5});
  expect_rectangle(surface.regions[1], {10, 20.5}, {10.5, 21});
  EXPECT_EQ(surface.regions[0].name, "image_0");
  EXPECT_EQ(surface.regions[1].name, "image_1");
  EXPECT_EQ(surface.regions[0].material.law, Law::rough);
}

TEST(ImageMap, TakesTheCellsAboveTheThresholdAndNotThoseOnIt) {
  // grey_8.png has the levels 0 51 255 over 128 254 1 of 255; 51/255 is 0.2.
  EXPECT_EQ(rectangles("file: grey_8.png, rough_above: 1"), 0U);
  EXPECT_EQ(rectangles("file: grey_8.png, rough_above: 0.2"), 2U);   // 255; 128 254
  EXPECT_EQ(rectangles("file: grey_8.png, rough_above: 0.19"), 2U);  // 51 255; 128 254
  EXPECT_EQ(rectangles("file: grey_8.png, rough_above: 0"), 2U);     // 51 255; the lower row
  EXPECT_EQ(rectangles("file: rgba.png, rough_above: 0.9"), 0U);     // the white pixel is transparent
}

TEST(ImageMap, LiesBelowTheListedRegions) {
  const Surface surface = read(
      "regions: [{name: pond, circle: {center: [0, 0], radius: 1}, law: smooth}]\n"
      "image: {file: corner.pgm, resolution: 0.5, origin: [0, 0], rough_above: 0.5}");
  ASSERT_EQ(surface.regions.size(), 3U);
  EXPECT_EQ(surface.regions[0].name, "image_0");
  EXPECT_EQ(surface.regions[2].name, "pond");
}

TEST(ImageMap, HasTheMaterialGivenForIt) {
  const Surface surface = read(
      "image: {file: corner.pgm, resolution: 0.5, origin: [0, 0], rough_above: 0.5, law: coulomb, friction: "
      "0.1,"
      " belt: [1, 2]}");
  for (const scene::Region& region : surface.regions) {
    EXPECT_EQ(region.material.law, Law::coulomb);
    EXPECT_EQ(region.material.friction, 0.1);
    EXPECT_EQ(region.material.belt, Vector2d(1, 2));
  }
}

TEST(ImageMap, TakesTheOccupiedCellsOfMapServer) {
  // Of 4 x 3 cells the upper row, the left column and the right cell of the middle row are occupied; one is
  // unknown (205).
  const Surface surface = read("image: {map: office.yaml}");
  ASSERT_EQ(surface.regions.size(), 3U);
  expect_rectangle(surface.regions[0], {-1, 2}, {-1 + 0.05, 2 + 2 * 0.05});
  expect_rectangle(surface.regions[1], {-1 + 3 * 0.05, 2 + 0.05}, {-1 + 4 * 0.05, 2 + 2 * 0.05});
  expect_rectangle(surface.regions[2], {-1, 2 + 2 * 0.05}, {-1 + 4 * 0.05, 2 + 3 * 0.05});
}

TEST(ImageMap, TakesTheLightCellsOfANegatedMap) {
  for (const char* negate : {"1", "true"}) {
    const TemporaryFile map("negated.yaml");
    map.fill("image: " + images + "/office.pgm\nresolution: 1\norigin: [0, 0, 0]\nnegate: " + negate +
             "\noccupied_thresh: 0.99\nmode: trinary\n");
    const Surface surface = read("image: {map: " + map.path() + "}", "");
    ASSERT_EQ(surface.regions.size(), 2U);
    expect_rectangle(surface.regions[0], {1, 0}, {4, 1});
    expect_rectangle(surface.regions[1], {1, 1}, {2, 2});
  }
}

TEST(ImageMap, IsLookedForBesideItsSceneFile) {
  const TemporaryFile image("floor.pgm");
  image.fill("P1 1 1 0");
  const TemporaryFile scene("scene.yaml");
  scene.fill("sphere: {mass: 1, radius: 1, body: solid}\nsurface: {image: {file: " +
             std::filesystem::path(image.path()).filename().string() +
             ", resolution: 1, origin: [0, 0], rough_above: 0.5}}\n");
  ASSERT_NE(std::filesystem::current_path(), std::filesystem::temp_directory_path());
  EXPECT_EQ(scene::read_scene_file(scene.path()).surface.regions.size(), 1U);
}

}  // namespace
}  // namespace hybrid_sphere::testing::read_image_test
