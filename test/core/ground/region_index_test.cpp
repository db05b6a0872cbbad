// The index against a look at every region, on maps whose coordinates are short numbers: there boxes touch
// exactly, and no rounding blurs whether they do.

#include "ground/region_index.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "geometry/hundred_digits.hpp"
#include "ground/ground.hpp"

namespace hybrid_sphere::testing::region_index_test {
namespace {

using scene::Circle;
using scene::HalfPlane;
using scene::Polygon;

constexpr double infinity = std::numeric_limits<double>::infinity();

class RandomMap {
 public:
  explicit RandomMap(unsigned seed) : engine_(seed) {}

  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
  Vector2d point(int size) { return {integer(-size, size) / 4.0, integer(-size, size) / 4.0}; }

  Polygon triangle(int size) {
    const Vector2d corner = point(size);
    return {{corner, corner + Vector2d(integer(1, 12), integer(-4, 4)) / 4.0,
             corner + Vector2d(integer(-4, 4), integer(16, 20)) / 4.0},
            false};
  }

  scene::Shape shape(int size) {
    const int kind = integer(0, 19);
    if (kind == 0) return HalfPlane{point(size), {1, integer(-3, 3) / 2.0}};
    const bool outside = kind == 1;
    if (kind % 2 == 0) return Circle{point(size), integer(1, 8) / 4.0, outside};
    Polygon polygon = triangle(size);
    polygon.outside = outside;
    return polygon;
  }

  scene::Surface surface(int regions, int size) {
    scene::Surface surface;
    for (int i = 0; i < regions; ++i) {
      surface.regions.push_back({"region_" + std::to_string(i), shape(size), scene::Law::rough});
    }
    return surface;
  }

 private:
  std::mt19937 engine_;
};

bool has_outside(const scene::Shape& shape) {
  if (const auto* circle = std::get_if<Circle>(&shape)) return circle->outside;
  if (const auto* polygon = std::get_if<Polygon>(&shape)) return polygon->outside;
  return false;
}

bool is_unbounded(const scene::Shape& shape) {
  return std::holds_alternative<HalfPlane>(shape) || has_outside(shape);
}

bool reaches(double low, double high, const std::vector<double>& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return *least <= high && low <= *most;
}

bool box_meets(const scene::Shape& shape, const Box& box) {
  std::vector<double> x;
  std::vector<double> y;
  if (const auto* circle = std::get_if<Circle>(&shape)) {
    x = {circle->center.x() - circle->radius, circle->center.x() + circle->radius};
    y = {circle->center.y() - circle->radius, circle->center.y() + circle->radius};
  } else {
    for (const Vector2d& vertex : std::get<Polygon>(shape).vertices) {
      x.push_back(vertex.x());
      y.push_back(vertex.y());
    }
  }
  return reaches(box.low.x(), box.high.x(), x) && reaches(box.low.y(), box.high.y(), y);
}

std::vector<RegionId> bounded_regions_meeting(const scene::Surface& surface, const Box& box) {
  std::vector<RegionId> ids;
  for (std::size_t i = 0; i < surface.regions.size(); ++i) {
    const scene::Shape& shape = surface.regions[i].shape;
    if (!is_unbounded(shape) && box_meets(shape, box)) ids.push_back(static_cast<RegionId>(i));
  }
  return ids;
}

std::vector<RegionId> answer(const RegionIndex& index, const Box& box) {
  std::vector<RegionId> ids;
  index.query(box, ids);
  return ids;
}

scene::Surface tiles(int columns, double width) {
  scene::Surface surface;
  for (int i = 0; i < columns * columns; ++i) {
    const int row = i / columns;
    const Vector2d low(width * (i - row * columns), width * row);
    const double x = low.x() + width;
    const double y = low.y() + width;
    surface.regions.push_back({"tile_" + std::to_string(i),
                               Polygon{{low, {x, low.y()}, {x, y}, {low.x(), y}}, false}, scene::Law::rough});
  }
  return surface;
}

TEST(RegionIndex, NamesTheRegionsThatALookAtEveryBoxFinds) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    RandomMap random(seed);
    const scene::Surface surface = random.surface(random.integer(1, 2000), random.integer(10, 200));
    const RegionIndex index(surface);
    std::size_t found = 0;
    for (int round = 0; round < 200; ++round) {
      const Vector2d low = random.point(200);
      const Vector2d size(random.integer(0, 40) / 4.0, random.integer(0, 40) / 4.0);
      const Box box{low, low + (round % 4 == 0 ? Vector2d::Zero() : size)};
      const std::vector<RegionId> expected = bounded_regions_meeting(surface, box);
      found += expected.size();
      ASSERT_EQ(answer(index, box), expected) << "seed " << seed << ", round " << round;
    }
    EXPECT_GT(found, 0U) << "seed " << seed;
  }
}

TEST(RegionIndex, AnswersBoxesWithoutEnd) {
  RandomMap random(100);
  const scene::Surface surface = random.surface(300, 100);
  const RegionIndex index(surface);
  const std::vector<Box> boxes{{{-infinity, -infinity}, {infinity, infinity}},
                               {{2, -infinity}, {infinity, infinity}},
                               {{-infinity, 1}, {infinity, 1}},
                               {{-infinity, -3}, {-20, infinity}}};
  for (const Box& box : boxes) {
    const std::vector<RegionId> expected = bounded_regions_meeting(surface, box);
    EXPECT_FALSE(expected.empty());
    EXPECT_EQ(answer(index, box), expected);
  }
  EXPECT_EQ(answer(index, boxes[0]).size() + index.unbounded().size(), surface.regions.size());
}

TEST(RegionIndex, CountsBoxesThatTouchAndNotThoseAnUlpAway) {
  const RegionIndex index(tiles(8, 1));
  const double beside = std::nextafter(1.0, 0.0);
  EXPECT_EQ(answer(index, {{1, 0.5}, {1, 0.5}}), (std::vector<RegionId>{0, 1}));
  EXPECT_EQ(answer(index, {{1, 1}, {1, 1}}), (std::vector<RegionId>{0, 1, 8, 9}));
  EXPECT_EQ(answer(index, {{beside, 0.5}, {beside, 0.5}}), (std::vector<RegionId>{0}));
  EXPECT_EQ(answer(index, {{9, 9}, {10, 10}}), std::vector<RegionId>{});
}

TEST(RegionIndex, ListsWhatHasNoBoundsInAscendingOrder) {
  RandomMap random(7);
  const scene::Surface surface = random.surface(500, 100);
  std::vector<RegionId> expected;
  for (std::size_t i = 0; i < surface.regions.size(); ++i) {
    if (is_unbounded(surface.regions[i].shape)) expected.push_back(static_cast<RegionId>(i));
  }
  ASSERT_GT(expected.size(), 10U);
  EXPECT_EQ(RegionIndex(surface).unbounded(), expected);
}

TEST(RegionIndex, OfAFewRegionsNamesThoseThatMeetTheBox) {
  scene::Surface surface = tiles(5, 1);
  surface.regions[3].shape = HalfPlane{{0, 0}, {1, 0}};
  const RegionIndex index(surface);
  EXPECT_TRUE(index.is_small());
  EXPECT_FALSE(RegionIndex(tiles(8, 1)).is_small());
  const std::vector<RegionId> all = answer(index, {{-9, -9}, {91, 91}});
  EXPECT_EQ(all.size(), 24U);
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
  EXPECT_EQ(std::count(all.begin(), all.end(), 3), 0);
  EXPECT_EQ(answer(index, {{90, 90}, {91, 91}}), std::vector<RegionId>{});
  EXPECT_EQ(index.unbounded(), std::vector<RegionId>{3});
  EXPECT_LT(index.spacing(), infinity);
  EXPECT_EQ(RegionIndex(tiles(2, 1)).spacing(), infinity);
  EXPECT_EQ(answer(RegionIndex(scene::Surface{}), {{0, 0}, {1, 1}}), std::vector<RegionId>{});
}

TEST(RegionIndex, AppendsToWhatTheListHolds) {
  const RegionIndex index(tiles(8, 1));
  std::vector<RegionId> ids{50, 40};
  index.query({{0.5, 0.5}, {1.5, 0.5}}, ids);
  EXPECT_EQ(ids, (std::vector<RegionId>{50, 40, 0, 1}));
}

TEST(RegionIndex, OutlivesItsSurfaceAndTheIndexItWasCopiedFrom) {
  const RegionIndex copy = RegionIndex(tiles(8, 1));
  EXPECT_EQ(answer(copy, {{0.5, 0.5}, {0.5, 0.5}}), std::vector<RegionId>{0});
}

TEST(BoxAround, HoldsACircleWhoseEdgeIsNoBinary64Number) {
  for (const auto& [center, radius] : {std::pair(0.1, 0.3), {1e15, 1e-12}, {-7e-7, 3e5}, {1 / 3.0, 1e-300}}) {
    const Box box = box_around(Circle{{center, -center}, radius, false});
    const exact::Real r(radius);
    EXPECT_LE(exact::Real(box.low.x()), exact::Real(exact::Real(center) - r));
    EXPECT_GE(exact::Real(box.high.x()), exact::Real(exact::Real(center) + r));
    EXPECT_LE(exact::Real(box.low.y()), exact::Real(-exact::Real(center) - r));
    EXPECT_GE(exact::Real(box.high.y()), exact::Real(-exact::Real(center) + r));
    // Half an ulp of rounding and the step outwards, at most two ulps of the larger number.
    const double slack = 4 * std::numeric_limits<double>::epsilon() * std::max(std::abs(center), radius);
    EXPECT_LE(box.high.x() - (center + radius), slack);
    EXPECT_LE(center - radius - box.low.x(), slack);
  }
}

TEST(Spacing, IsOfTheSizeOfTilesThatFillThePlane) {
  const double spacing = RegionIndex(tiles(40, 3)).spacing();
  EXPECT_GE(spacing, 3);
  EXPECT_LE(spacing, 6);
}

TEST(Spacing, ScalesWithTheMap) {
  RandomMap random(11);
  const scene::Surface surface = random.surface(400, 100);
  scene::Surface scaled = surface;
  // A power of two: no rounding anywhere.
  for (scene::Region& region : scaled.regions) {
    if (auto* circle = std::get_if<Circle>(&region.shape)) {
      circle->center *= 0x1p-20;
      circle->radius *= 0x1p-20;
    } else if (auto* polygon = std::get_if<Polygon>(&region.shape)) {
      for (Vector2d& vertex : polygon->vertices) vertex *= 0x1p-20;
    }
  }
  EXPECT_EQ(RegionIndex(scaled).spacing(), 0x1p-20 * RegionIndex(surface).spacing());
}

TEST(Spacing, IsThatOfTheCrowdWhateverLiesFarAway) {
  scene::Surface surface = tiles(40, 1);
  surface.regions.push_back({"far", Circle{{1e12, 1e12}, 1, false}, scene::Law::rough});
  surface.regions.push_back({"huge", Circle{{20, 20}, 1e9, false}, scene::Law::rough});
  EXPECT_LE(RegionIndex(surface).spacing(), 2);
}

TEST(Spacing, OfSmallRegionsFarApartIsTheirDistance) {
  scene::Surface surface;
  for (int i = 0; i < 400; ++i) {
    const Vector2d center(i % 20, i / 20);
    surface.regions.push_back({"disc_" + std::to_string(i), Circle{center, 1e-6, false}, scene::Law::rough});
  }
  const double spacing = RegionIndex(surface).spacing();
  EXPECT_GE(spacing, 1);
  EXPECT_LE(spacing, 3);
}

TEST(Ground, HasTheTopRegionThatALookAtEveryRegionFinds) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    RandomMap random(seed);
    const int regions = seed % 2 == 0 ? random.integer(1, 30) : random.integer(60, 600);
    scene::Surface surface = random.surface(regions, 100);
    // A region without bounds hides most of what lies below it: in two maps of three it lies low.
    if (seed % 3 != 0) {
      std::stable_partition(surface.regions.begin(), surface.regions.end(),
                            [](const scene::Region& region) { return is_unbounded(region.shape); });
    }
    const Ground ground(surface);
    for (int round = 0; round < 300; ++round) {
      const Vector2d point = random.point(120);
      RegionId expected = ground.size() - 1;
      while (expected >= 0 && locate(ground.shape(expected), point) == Side::outside) --expected;
      ASSERT_EQ(ground.top_region(point), expected) << "seed " << seed << ", at " << point.transpose();
    }
  }
}

TEST(Ground, HasTheMaterialOfEachRegionAndOfTheBase) {
  scene::Surface surface = tiles(2, 1);
  surface.base.belt = {1, 2};
  surface.regions[2].material = scene::Law::coulomb;
  surface.regions[2].material.friction = 0.25;
  const Ground ground(surface);
  EXPECT_EQ(ground.material(base_region).belt, Vector2d(1, 2));
  EXPECT_EQ(ground.material(2).friction, 0.25);
  EXPECT_EQ(ground.law(2), scene::Law::coulomb);
  EXPECT_EQ(ground.law(base_region), scene::Law::smooth);
}

}  // namespace
}  // namespace hybrid_sphere::testing::region_index_test
