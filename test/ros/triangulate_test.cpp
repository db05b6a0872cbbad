#include "ros/markers/triangulate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "geometry/simple_polygon.hpp"
#include "support/patience.hpp"

namespace hybrid_sphere::ros_interface::triangulate_test {
namespace {

using Eigen::Vector2d;
using Corners = std::vector<Vector2d>;

double doubled_area(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

using Rings = std::vector<Corners>;

double area_of_polygon(const Corners& corners) {
  double sum = 0;
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    sum += doubled_area(corners[0], corners[i], corners[i + 1]);
  }
  return sum / 2;
}

/// Even-odd rule.
bool contains(const Corners& corners, const Vector2d& p) {
  bool inside = false;
  for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
    const Vector2d& a = corners[i];
    const Vector2d& b = corners[j];
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x()) {
      inside = !inside;
    }
  }
  return inside;
}

/// Positive triangles within the region whose areas add up to its own cover it exactly once.
void expect_covers(const Rings& rings) {
  const Corners triangles = triangulate(rings);
  ASSERT_EQ(triangles.size() % 3, 0U);
  std::size_t most = 0;
  double whole = 0;
  for (const Corners& ring : rings) {
    most += ring.size() - 2 + (most > 0 ? 4 : 0);  // two for each hole: a cut along a line there and back
    whole += area_of_polygon(ring);
  }
  EXPECT_LE(triangles.size() / 3, most);
  double area = 0;
  for (std::size_t i = 0; i < triangles.size(); i += 3) {
    const double twice = doubled_area(triangles[i], triangles[i + 1], triangles[i + 2]);
    EXPECT_GE(twice, 0);
    area += twice / 2;
    if (twice > 1e-9) {
      const Vector2d middle = (triangles[i] + triangles[i + 1] + triangles[i + 2]) / 3;
      int containing = 0;
      for (const Corners& ring : rings) containing += contains(ring, middle) ? 1 : 0;
      EXPECT_EQ(containing % 2, 1) << middle.transpose();
    }
  }
  EXPECT_NEAR(area, whole, 1e-10 * std::abs(area));
}

void expect_covers(const Corners& corners) { expect_covers(Rings{corners}); }

Corners reversed(Corners corners) {
  std::reverse(corners.begin(), corners.end());
  return corners;
}

Corners star(std::mt19937& engine, int corners, const Vector2d& center, double largest) {
  std::uniform_real_distribution<double> radius(0.05 * largest, largest);
  Corners star;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * 3.14159265358979 * i / corners;
    star.push_back(radius(engine) * Vector2d(std::cos(angle), std::sin(angle)) + center);
  }
  return star;
}

TEST(Triangulate, AConvexPolygon) { expect_covers({{0, 0}, {2, 0}, {3, 1}, {1, 3}, {-1, 1}}); }

TEST(Triangulate, CornersOnAStraightSide) {
  expect_covers({{0, 0}, {1, 0}, {2, 0}, {2, 2}, {1, 2}, {0, 2}, {0, 1}});
}

Corners comb(int corners) {
  Corners comb;
  for (int i = 0; i < corners; ++i) comb.emplace_back(i, i % 2 == 0 ? 0 : 5);
  comb.emplace_back(corners - 1, 6);
  comb.emplace_back(0, 6);
  return comb;
}

TEST(Triangulate, ACombFromEverySide) {
  Corners corners = comb(40);
  for (int side = 0; side < 4; ++side) {
    expect_covers(corners);
    for (Vector2d& corner : corners) corner = Vector2d(-corner.y(), corner.x());
  }
}

TEST(Triangulate, ASpiral) {
  Corners spiral;
  for (int i = 0; i <= 60; ++i) {
    spiral.push_back((1 + 0.10 * i) * Vector2d(std::cos(0.3 * i), std::sin(0.3 * i)));
  }
  for (int i = 60; i >= 0; --i) {
    spiral.push_back((0.5 + 0.10 * i) * Vector2d(std::cos(0.3 * i), std::sin(0.3 * i)));
  }
  if (area_of_polygon(spiral) < 0) std::reverse(spiral.begin(), spiral.end());
  expect_covers(spiral);
}

TEST(Triangulate, RandomStars) {
  std::mt19937 engine(3);
  for (int round = 0; round < 500; ++round) {
    expect_covers(star(engine, 3 + round % 60, Vector2d(100, -7), 2));
  }
}

TEST(Triangulate, RandomStarsOnAGridHaveCornersAboveEachOtherAndOnStraightLines) {
  std::mt19937 engine(4);
  int simple = 0;
  for (int round = 0; round < 3000; ++round) {
    Corners corners;
    for (const Vector2d& corner : star(engine, 3 + round % 20, Vector2d::Zero(), 6)) {
      corners.emplace_back(std::round(corner.x()), std::round(corner.y()));
    }
    if (geometry::fault_of_polygon(corners) || !geometry::is_counter_clockwise(corners)) continue;
    ++simple;
    expect_covers(corners);
  }
  EXPECT_GT(simple, 500);
}

TEST(Triangulate, ASquareWithAHole) {
  expect_covers(Rings{{{-3, -3}, {3, -3}, {3, 3}, {-3, 3}}, {{1, 0}, {0, -1}, {-1, 0}, {0, 1}}});
}

TEST(Triangulate, ASquareWithHolesInARow) {
  Rings rings{{{0, 0}, {21, 0}, {21, 3}, {0, 3}}};
  for (int i = 0; i < 10; ++i) {
    rings.push_back({{2. * i + 1, 1}, {2. * i + 1, 2}, {2. * i + 2, 2}, {2. * i + 2, 1}});
  }
  expect_covers(rings);
}

TEST(Triangulate, RandomStarsWithStarsAsHoles) {
  std::mt19937 engine(5);
  for (int round = 0; round < 200; ++round) {
    Rings rings{{{-10, -10}, {10, -10}, {10, 10}, {-10, 10}}};
    for (int i = 0; i < 16; ++i) {
      rings.push_back(
          reversed(star(engine, 3 + (round + i) % 9, {5. * (i % 4) - 7.5, 5. * (i / 4) - 7.5}, 2.4)));
    }
    expect_covers(rings);
  }
}

// A time quadratic in the corners would be a thousand times as long, which the guard ends.
TEST(Triangulate, AMillionCorners) {
  std::mt19937 engine(6);
  for (const Corners& corners : {star(engine, 1'000'000, Vector2d::Zero(), 1), comb(1'000'000)}) {
    const testing::HangGuard guard;
    EXPECT_EQ(triangulate({corners}).size() / 3, corners.size() - 2);
  }
}

TEST(Triangulate, NothingOfLessThanThreeCorners) {
  EXPECT_TRUE(triangulate({}).empty());
  EXPECT_TRUE(triangulate({{{0, 0}, {1, 1}}}).empty());
}

TEST(Triangulate, NothingOfWhatIsNoRegionAndNoEndlessLoop) {
  std::mt19937 engine(7);
  std::uniform_int_distribution<int> place(-4, 4);
  for (int round = 0; round < 20000; ++round) {
    Corners corners;
    for (int i = 0; i < 3 + round % 9; ++i) corners.emplace_back(place(engine), place(engine));
    EXPECT_EQ(triangulate({corners}).size() % 3, 0U);
  }
}

}  // namespace
}  // namespace hybrid_sphere::ros_interface::triangulate_test
