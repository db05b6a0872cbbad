// What an image of the largest size takes while it is read.

#include <gtest/gtest.h>

#include "scene/read_tree.hpp"
#include "scene/yaml.hpp"
#include "support/limited_memory.hpp"
#include "support/temporary_file.hpp"

namespace hybrid_sphere::testing::image_memory_test {
namespace {

TEST(ImageMap, OfTheLargestSizeTakesTwiceItsCellsAndItsFileWhileItIsRead) {
  const TemporaryFile file("largest.pgm");
  const std::size_t side = 4096;  // 16 Mi cells, of a byte each in the file
  file.fill("P5 4096 4096 255\n" + std::string(side * side, '\0'));
  // The file beside a level of 4 bytes for each cell, then those beside a byte for each cell; 2 MB for the
  // rest.
  const std::size_t enough = side * side * (4 + 1) + 2'000'000;
  const std::string text =
      "image: {file: " + file.path() + ", resolution: 1, origin: [0, 0], rough_above: 0.5}";
  EXPECT_EQ(outcome_within(enough, [&] { scene::read_surface(scene::tree_from_yaml(text), "surface"); }),
            "accepted");
}

}  // namespace
}  // namespace hybrid_sphere::testing::image_memory_test
