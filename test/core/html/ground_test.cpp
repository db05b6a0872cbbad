// What of the ground a page draws.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "html/drawn_ground.hpp"
#include "scene/cell_map.hpp"

namespace hybrid_sphere::testing::ground_test {
namespace {

using html::Drawing;
using html::Ring;

constexpr double pi = 3.14159265358979323846;
const Drawing square{{100, 50}, {{-4, -4}, {4, 4}}, 1e-3};  // 8 m x 8 m around (100, 50)

double area(const std::vector<Ring>& rings) {
  double twice = 0;
  for (const Ring& ring : rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vector2d& a = ring[i];
      const Vector2d& b = ring[(i + 1) % ring.size()];
      twice += a.x() * b.y() - a.y() * b.x();
    }
  }
  return twice / 2;
}

TEST(Rings, AHalfPlaneIsCutToTheDrawing) {
  EXPECT_NEAR(area(rings_of(scene::HalfPlane{{99, 7}, {3, 0}}, square)), 8 * 5, 1e-12);
  EXPECT_NEAR(area(rings_of(scene::HalfPlane{{100, 50}, {-1e-200, 1e-200}}, square)), 32, 1e-12);
  EXPECT_TRUE(rings_of(scene::HalfPlane{{105, 0}, {1, 0}}, square).empty());
}

TEST(Rings, ACircleIsWithinTheTolerance) {
  const double drawn = area(rings_of(scene::Circle{{100, 50}, 2}, square));
  EXPECT_LT(drawn, 4 * pi);
  // A chord is at most the tolerance inside the circle.
  EXPECT_GT(drawn, 4 * pi - 2 * pi * 2 * square.tolerance);
  EXPECT_NEAR(area(rings_of(scene::Circle{{100, 50}, 2, true}, square)), 64 - drawn, 1e-9);
  EXPECT_TRUE(rings_of(scene::Circle{{110, 50}, 2}, square).empty());
  EXPECT_NEAR(area(rings_of(scene::Circle{{110, 50}, 2, true}, square)), 64, 1e-12);
}

TEST(Rings, AHugeCircleIsAlmostAHalfPlane) {
  for (const double radius : {1e3, 1e6, 1e9}) {
    // Of x <= 101 the circle leaves out at most 8 * 4^2 / (2 radius); rounding is 1e-16 radius.
    const double drawn = area(rings_of(scene::Circle{{101 - radius, 50}, radius}, square));
    EXPECT_NEAR(drawn, 8 * 5, 64 / radius + 8e-16 * radius + 1e-6) << radius;
  }
  EXPECT_NEAR(area(rings_of(scene::Circle{{100, 50}, 1e12}, square)), 64, 1e-12);
  EXPECT_TRUE(rings_of(scene::Circle{{100, 50}, 1e12, true}, square).empty());
}

TEST(Rings, APolygonIsCutToTheDrawing) {
  const scene::Polygon polygon{{{90, 40}, {100, 40}, {100, 60}, {90, 60}}};
  EXPECT_NEAR(area(rings_of(polygon, square)), 4 * 8, 1e-12);
  const scene::Polygon hole{{{99, 49}, {101, 49}, {101, 51}, {99, 51}}, true};
  EXPECT_NEAR(area(rings_of(hole, square)), 64 - 4, 1e-12);
}

/// Squares of 0.5 m on a grid of 1 m, so many along a side, the first at the origin.
scene::Surface squares(int side) {
  scene::Surface surface;
  for (int i = 0; i < side * side; ++i) {
    const Vector2d low(i % side, i / side);
    const scene::Polygon polygon{
        {low, low + Vector2d(0.5, 0), low + Vector2d(0.5, 0.5), low + Vector2d(0, 0.5)}};
    surface.regions.push_back({"r" + std::to_string(i), polygon, scene::Law::rough});
  }
  return surface;
}

TEST(DrawnGround, OfManyRegionsHasThoseNearThePath) {
  const scene::Surface surface = squares(316);  // 99,856
  std::vector<Vector2d> path;
  for (int i = 0; i <= 100; ++i) path.emplace_back(10 + 2 * i, 100);
  const auto ground = html::draw_ground(surface, path, 0.1, 60'000);
  EXPECT_GT(ground.regions.size(), 400U);
  EXPECT_LT(ground.regions.size(), 2000U);
  EXPECT_EQ(ground.regions.size() + ground.left_out + ground.beyond, surface.regions.size());
  for (std::size_t i = 0; i < ground.regions.size(); ++i) {
    const Vector2d at = ground.regions[i].rings[0][0] + ground.drawing.origin;
    EXPECT_LT(std::abs(at.y() - 100), 6);
    if (i == 0) continue;
    EXPECT_GT(ground.regions[i].region, ground.regions[i - 1].region);
  }
}

TEST(DrawnGround, TheViewHoldsThePathAndWhatIsNear) {
  scene::Surface surface;
  surface.regions.push_back({"near", scene::Circle{{1, 3}, 0.5}, scene::Law::rough});
  surface.regions.push_back({"far", scene::Circle{{1000, 0}, 1}, scene::Law::rough});
  const auto ground = html::draw_ground(surface, {{-2, 0}, {4, 0}}, 0.1, 60'000);
  EXPECT_GE(ground.drawing.origin.y() + ground.extent.y(), 3.5);
  EXPECT_LT(ground.view, 10);
  ASSERT_EQ(ground.regions.size(), 1U);
  EXPECT_EQ(ground.beyond, 1U);
}

TEST(DrawnGround, ManyCellsAreAPictureOfTheSameCells) {
  scene::Surface surface = squares(64);
  surface.image_regions = surface.regions.size();
  surface.regions.push_back({"over it", scene::Circle{{1, 3}, 0.5}, scene::Law::smooth});
  const auto ground = html::draw_ground(surface, {{0, 0}, {60, 60}}, 0.1, 200'000);
  ASSERT_TRUE(ground.cells);
  ASSERT_EQ(ground.regions.size(), 1U);
  const html::CellRaster& cells = *ground.cells;
  EXPECT_EQ(cells.columns, 127U);
  EXPECT_EQ(cells.rows, 127U);
  for (std::size_t i = 0; i < cells.columns * cells.rows; ++i) {
    const bool is_cell = (i % cells.columns) % 2 == 0 && (i / cells.columns) % 2 == 0;
    ASSERT_EQ((cells.bits[i / 8] >> (7 - i % 8) & 1) != 0, is_cell) << i;
  }
  const auto smaller = html::draw_ground(surface, {{0, 0}, {60, 60}}, 0.1, 2000);
  ASSERT_TRUE(smaller.cells);
  EXPECT_LT(smaller.cells->bits.size(), 1000U);
}

TEST(DrawnGround, ManyTurnedCellsAreAPictureOfTheSameCells) {
  constexpr std::size_t side = 127;
  const Vector2d axis(0.6, 0.8);
  const Vector2d across(-0.8, 0.6);
  scene::CellMap map{side, side, 1, {0, 0}, {}, axis};
  for (std::size_t i = 0; i < side * side; ++i)
    map.belonging.push_back((i % side) % 2 == 0 && (i / side) % 2 == 0 ? 1 : 0);
  scene::Surface surface;
  surface.regions = scene::regions_of(map, scene::Law::rough, "cell_", "map");
  surface.image_regions = surface.regions.size();
  const auto ground = html::draw_ground(surface, {{-101, 0}, {77, 178}}, 0.1, 200'000);
  ASSERT_TRUE(ground.cells);
  const html::CellRaster& cells = *ground.cells;
  const Vector2d size = cells.box.high - cells.box.low;
  for (std::size_t i = 0; i < cells.columns * cells.rows; ++i) {
    const std::size_t column = i % cells.columns;
    const std::size_t row = i / cells.columns;
    const Vector2d share((static_cast<double>(column) + 0.5) / static_cast<double>(cells.columns),
                         (static_cast<double>(row) + 0.5) / static_cast<double>(cells.rows));
    const Vector2d centre = ground.drawing.origin + cells.box.low + share.cwiseProduct(size);
    const double u = axis.dot(centre);
    const double v = across.dot(centre);
    const double from_edge = std::min(std::abs(u - std::round(u)), std::abs(v - std::round(v)));
    if (from_edge < 1e-9) continue;  // round-off decides
    const auto is_even = [](double w) { return std::fmod(std::floor(w), 2) == 0; };
    const bool is_cell = is_even(u) && is_even(v) && std::min(u, v) > 0 && std::max(u, v) < side;
    ASSERT_EQ((cells.bits[i / 8] >> (7 - i % 8) & 1) != 0, is_cell) << u << ", " << v;
  }
}

TEST(DrawnGround, OfAPointIsSomeGroundAroundTheSphere) {
  for (const double radius : {1e-12, 1e-3, 1e6, 1e12}) {
    const auto ground = html::draw_ground({}, {{1e10, -1e10}}, radius, 60'000);
    EXPECT_GE(ground.view, 3 * radius);
    EXPECT_EQ(ground.drawing.origin, Vector2d(1e10, -1e10));
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::ground_test
