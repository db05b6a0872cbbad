#include "scene/cell_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace hybrid_sphere::testing::cell_map_test {
namespace {

using scene::CellMap;
using scene::Region;

/// Rows of '#' (belongs) and '.', the uppermost first.
CellMap drawn(const std::vector<std::string>& rows) {
  CellMap cells{rows.front().size(), rows.size(), 0.1, {-0.3, 7}, {}};
  for (auto row = rows.rbegin(); row != rows.rend(); ++row) {
    for (const char c : *row) cells.belonging.push_back(c == '#' ? 1 : 0);
  }
  return cells;
}

std::vector<Region> regions_of(const CellMap& cells) {
  return scene::regions_of(cells, scene::Law::rough, "cell_", "grid");
}

std::string refusal(const CellMap& cells) {
  try {
    regions_of(cells);
  } catch (const scene::SceneError& error) {
    return error.what();
  }
  return "accepted";
}

const std::vector<Vector2d>& corners(const Region& region) {
  return std::get<scene::Polygon>(region.shape).vertices;
}

/// How many regions hold the centre of each cell.
std::vector<int> covers(const CellMap& cells, const std::vector<Region>& regions) {
  std::vector<int> count(cells.belonging.size(), 0);
  for (std::size_t i = 0; i < count.size(); ++i) {
    const double x = cells.origin.x() + (static_cast<double>(i % cells.width) + 0.5) * cells.resolution;
    const double y = cells.origin.y() + (static_cast<double>(i / cells.width) + 0.5) * cells.resolution;
    for (const Region& region : regions) {
      const Vector2d& low = corners(region)[0];
      const Vector2d& high = corners(region)[2];
      if (low.x() < x && x < high.x() && low.y() < y && y < high.y()) ++count[i];
    }
  }
  return count;
}

TEST(CellMap, JoinsAllCellsOfARectangle) {
  const std::vector<Region> regions = regions_of(drawn({".....", ".###.", ".###.", "....."}));
  ASSERT_EQ(regions.size(), 1U);
  EXPECT_EQ(regions[0].name, "cell_0");
  EXPECT_EQ(regions[0].material.law, scene::Law::rough);
  const std::vector<Vector2d> counter_clockwise = {{-0.2, 7.1}, {0.1, 7.1}, {0.1, 7.3}, {-0.2, 7.3}};
  EXPECT_EQ(corners(regions[0]), counter_clockwise);
}

TEST(CellMap, JoinsOnlyEqualRunsOfNeighbouringRows) {
  EXPECT_EQ(regions_of(drawn({"##.##", "##.##", "#####"})).size(), 3U);
  EXPECT_EQ(regions_of(drawn({"###", "...", "###"})).size(), 2U);
  EXPECT_EQ(regions_of(drawn({".##", "##."})).size(), 2U);
  EXPECT_EQ(regions_of(drawn({"#.#.#", "#...#", "#.#.#"})).size(), 4U);
  EXPECT_TRUE(regions_of(drawn({"...", "..."})).empty());
}

TEST(CellMap, IsNumberedFromItsLowestRow) {
  const std::vector<Region> regions = regions_of(drawn({"#...", "..##"}));
  ASSERT_EQ(regions.size(), 2U);
  EXPECT_EQ(corners(regions[0])[0], Vector2d(-0.1, 7));
  EXPECT_EQ(corners(regions[1])[0], Vector2d(-0.3, 7.1));
}

TEST(CellMap, CoversEachCellThatBelongsOnceAndNoOther) {
  std::mt19937 random(7);
  for (const int percent : {5, 50, 95}) {
    CellMap cells{37, 23, 0.05, {-12.34, 0.1}, {}};
    for (int i = 0; i < 37 * 23; ++i) cells.belonging.push_back(random() % 100 < unsigned(percent) ? 1 : 0);
    const std::vector<int> expected(cells.belonging.begin(), cells.belonging.end());
    EXPECT_EQ(covers(cells, regions_of(cells)), expected) << percent << " % belong";
  }
}

TEST(CellMap, GivesNeighboursTheSameCoordinatesToTheBit) {
  CellMap cells = drawn({"#.", ".#"});
  cells.resolution = 0.1;
  cells.origin = {1e6 / 3, -1e-3 / 7};
  const std::vector<Region> regions = regions_of(cells);
  ASSERT_EQ(regions.size(), 2U);
  EXPECT_EQ(corners(regions[0])[3], corners(regions[1])[1]);  // they meet in one point
}

// -0.3 + 5 0.1 is 0.2, and -0.7 + 3 0.1 is -0.4, whatever a sum of the binary numbers is.
TEST(CellMap, HasItsLinesAtTheNumbersThatAreWritten) {
  CellMap cells{8, 1, 0.1, {-0.7, 1e-3}, std::vector<std::uint8_t>(8, 0)};
  cells.belonging[3] = 1;
  EXPECT_EQ(corners(regions_of(cells)[0])[0], Vector2d(-0.4, 0.001));
  EXPECT_EQ(corners(regions_of(cells)[0])[2], Vector2d(-0.3, 0.101));
  cells.resolution = 1. / 3;  // has no short decimal
  EXPECT_EQ(corners(regions_of(cells)[0])[0].x(), -0.7 + 3 * (1. / 3));
  cells.resolution = 250;
  cells.origin.x() = 12500;
  EXPECT_EQ(corners(regions_of(cells)[0])[0].x(), 13250);
}

TEST(CellMap, IsRefusedWithoutCells) {
  EXPECT_EQ(refusal(CellMap{0, 5, 1, {0, 0}, {}}),
            "grid: a map of 0 x 5 cells is refused; allowed: at least 1 x 1, up to 16777216 cells");
  EXPECT_EQ(refusal(CellMap{5, 0, 1, {0, 0}, {}}).rfind("grid: a map of 5 x 0 cells is refused", 0), 0U);
}

TEST(CellMap, IsRefusedWithTooManyCells) {
  // Their product wraps round to 0 in 64 bits.
  const std::size_t side = std::size_t{1} << 32U;
  EXPECT_EQ(refusal(CellMap{side, side, 1, {0, 0}, {}}).rfind("grid: a map of 4294967296 x ", 0), 0U);
}

TEST(CellMap, IsRefusedWithTheWrongNumberOfValues) {
  EXPECT_EQ(refusal(CellMap{2, 2, 1, {0, 0}, {1, 1, 1}}),
            "grid: a map with the values of 3 cells is refused; allowed: 4, width times height");
}

TEST(CellMap, IsRefusedWithABadResolutionOrOrigin) {
  const double nan = std::nan("");
  EXPECT_EQ(refusal(CellMap{1, 1, 0, {0, 0}, {1}}).rfind("grid.resolution: 0 is refused", 0), 0U);
  EXPECT_EQ(refusal(CellMap{1, 1, nan, {0, 0}, {1}}).rfind("grid.resolution: nan is refused", 0), 0U);
  EXPECT_EQ(refusal(CellMap{1, 1, 1, {nan, 0}, {1}}).rfind("grid.origin: nan is refused", 0), 0U);
  EXPECT_EQ(refusal(CellMap{2, 1, 1e-3, {0, 1e14}, {1, 1}}).rfind("grid.resolution: 0.001 is refused", 0),
            0U);
}

TEST(CellMap, IsRefusedWithTooManyRectangles) {
  CellMap chessboard{2050, 1024, 1, {0, 0}, {}};
  for (std::size_t y = 0; y < chessboard.height; ++y) {
    for (std::size_t x = 0; x < chessboard.width; ++x)
      chessboard.belonging.push_back((x + y) % 2 == 0 ? 1 : 0);
  }
  EXPECT_EQ(refusal(chessboard).rfind("grid: a map of more than 1048576 rectangles is refused", 0), 0U);
}

}  // namespace
}  // namespace hybrid_sphere::testing::cell_map_test
