// Files of map_server become the ground that its topic becomes. The expected values are those of
// map_server's image_loader.cpp (ROS navigation 1.17), computed by hand.

#include <gtest/gtest.h>

#include "scene/read_tree.hpp"
#include "scene/yaml.hpp"
#include "support/temporary_file.hpp"

namespace hybrid_sphere::testing::map_server_test {
namespace {

using scene::Surface;

const std::string images = std::string(TEST_DATA_DIR) + "/images/";

struct Read {
  Surface surface;
  std::vector<std::string> warnings;
};

/// The ground of a map file with an image and further keys.
Read read(const std::string& image, const std::string& keys) {
  const TemporaryFile map("map.yaml");
  map.fill("image: " + image + "\nresolution: 1\noccupied_thresh: 0.65\nfree_thresh: 0.196\n" + keys);
  Read result;
  result.surface = scene::read_surface(scene::tree_from_yaml("image: {map: " + map.path() + "}"), "surface",
                                       "", &result.warnings);
  return result;
}

/// Which cells of the only row of an image are rough: "#" and ".".
std::string row_of(const std::string& image, std::size_t width, const std::string& keys) {
  std::string row(width, '.');
  for (const scene::Region& region : read(image, "origin: [0, 0, 0]\n" + keys).surface.regions) {
    const auto& corners = std::get<scene::Polygon>(region.shape).vertices;
    for (double x = corners[0].x(); x < corners[1].x(); ++x) row[static_cast<std::size_t>(x)] = '#';
  }
  return row;
}

std::string refusal(const std::string& image, const std::string& keys) {
  try {
    read(image, keys);
  } catch (const scene::SceneError& error) {
    return error.what();
  }
  return "";
}

TEST(MapOfMapServer, AveragesOpacityInTrinaryMode) {
  // The means are 86.25 255 123.75 0 75 138.75 160.5 161.25; occupied is what is below 89.25.
  EXPECT_EQ(row_of(images + "map_rgba.png", 8, ""), "#..##...");
  // Negated: occupied is what is above 165.75.
  EXPECT_EQ(row_of(images + "map_rgba.png", 8, "negate: 1\n"), ".#......");
}

TEST(MapOfMapServer, ScalesOccupanciesBetweenTheThresholds) {
  // Means of the colours 30 255 80 0 100 100 129 130. Between the thresholds lie 90 to 205, of which the
  // fully transparent one is unknown, 100 becomes 89, 129 becomes 65 and 130 becomes 64.
  EXPECT_EQ(row_of(images + "map_rgba.png", 8, "mode: scale\n"), "#.##.##.");
  EXPECT_EQ(row_of(images + "map_rgba.png", 8, "mode: trinary\n"), "#..##...");
}

TEST(MapOfMapServer, TakesRawLevelsAsOccupancies) {
  const TemporaryFile image("raw.pgm");
  image.fill("P2 6 1 255  0 64 65 99 100 255");
  EXPECT_EQ(row_of(image.path(), 6, "mode: raw\n"), "..###.");
  image.fill("P2 6 1 255  255 191 190 155 0 254");
  EXPECT_EQ(row_of(image.path(), 6, "mode: raw\nnegate: 1\n"), "..##..");
  image.fill("P2 2 1 255  0 101");
  EXPECT_EQ(
      refusal(image.path(), "origin: [0, 0, 0]\nmode: raw\n"),
      "surface.image.map.mode: raw, with a pixel of the level 101 is refused; allowed: levels from 0 to "
      "100, and 255 for unknown");
}

TEST(MapOfMapServer, IgnoresTheGammaOfAnImage) {
  EXPECT_EQ(row_of(images + "gamma.png", 4, ""), "##..");  // 0 80 100 255; occupied is what is below 89.25
}

TEST(MapOfMapServer, TurnsAboutItsOrigin) {
  const TemporaryFile image("turned.pgm");
  image.fill("P2 2 1 255  0 255");
  const Surface surface = read(image.path(), "origin: [3, -2, 1.5707963267948966]\n").surface;
  ASSERT_EQ(surface.regions.size(), 1U);
  const auto& corners = std::get<scene::Polygon>(surface.regions[0].shape).vertices;
  const std::vector<Vector2d> expected{{3, -2}, {3, -1}, {2, -1}, {2, -2}};
  ASSERT_EQ(corners.size(), expected.size());
  // The cosine of the angle as it is rounded is 6.1e-17.
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_LE((corners[i] - expected[i]).norm(), 1e-15) << i;
  EXPECT_EQ(refusal(image.path(), "origin: [0, 0, .nan]\n").rfind("surface.image.map.origin[2]: nan", 0), 0U);
}

TEST(MapOfMapServer, HasNoGapsBetweenItsTurnedCells) {
  const TemporaryFile image("corner.pgm");
  image.fill("P2 3 2 255  0 255 255  0 0 0");
  const Surface surface = read(image.path(), "origin: [0.1, 0.2, 0.7]\n").surface;
  ASSERT_EQ(surface.regions.size(), 2U);
  // The lower rectangle has a corner where the upper one ends.
  const auto& lower = std::get<scene::Polygon>(surface.regions[0].shape).vertices;
  const auto& upper = std::get<scene::Polygon>(surface.regions[1].shape).vertices;
  ASSERT_EQ(lower.size(), 5U);
  ASSERT_EQ(upper.size(), 4U);
  EXPECT_EQ(lower[3], upper[1]);
  EXPECT_EQ(lower[4], upper[0]);
}

TEST(MapOfMapServer, WarnsOfAKeyThatMapServerDoesNotKnow) {
  const Read map = read(images + "corner.pgm", "origin: [0, 0, 0]\nnegat: 1\ncost_scaling: {a: 1}\n");
  EXPECT_GT(map.surface.regions.size(), 0U);
  ASSERT_EQ(map.warnings.size(), 2U);
  EXPECT_EQ(map.warnings[0],
            "surface.image.map.negat: an unknown key is ignored (did you mean negate?); known: image, "
            "resolution, origin, negate, occupied_thresh, free_thresh, mode");
}

}  // namespace
}  // namespace hybrid_sphere::testing::map_server_test
