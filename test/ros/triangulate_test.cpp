#include "hybrid_sphere/ros/triangulate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace hybrid_sphere::ros_interface {
namespace {

using Eigen::Vector2d;
using Corners = std::vector<Vector2d>;

double doubled_area(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

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

/// Positive triangles within the polygon whose areas add up to its own cover it exactly once.
void expect_covers(const Corners& corners) {
  const Corners triangles = triangulate(corners);
  ASSERT_EQ(triangles.size() % 3, 0U);
  EXPECT_LE(triangles.size() / 3, corners.size() - 2);
  double area = 0;
  for (std::size_t i = 0; i < triangles.size(); i += 3) {
    const double twice = doubled_area(triangles[i], triangles[i + 1], triangles[i + 2]);
    EXPECT_GE(twice, 0);
    area += twice / 2;
    if (twice > 1e-9) {
      EXPECT_TRUE(contains(corners, (triangles[i] + triangles[i + 1] + triangles[i + 2]) / 3));
    }
  }
  EXPECT_NEAR(area, area_of_polygon(corners), 1e-10 * std::abs(area));
}

TEST(Triangulate, AConvexPolygon) { expect_covers({{0, 0}, {2, 0}, {3, 1}, {1, 3}, {-1, 1}}); }

TEST(Triangulate, CornersOnAStraightSide) {
  expect_covers({{0, 0}, {1, 0}, {2, 0}, {2, 2}, {1, 2}, {0, 2}, {0, 1}});
}

TEST(Triangulate, AComb) {
  Corners comb;
  for (int i = 0; i < 40; ++i) comb.emplace_back(i, i % 2 == 0 ? 0 : 5);
  comb.emplace_back(39, 6);
  comb.emplace_back(0, 6);
  expect_covers(comb);
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
  std::uniform_real_distribution<double> radius(0.1, 2);
  for (int round = 0; round < 50; ++round) {
    Corners star;
    for (int i = 0; i < 30; ++i) {
      const double angle = 2 * 3.14159265358979 * i / 30;
      star.push_back(radius(engine) * Vector2d(std::cos(angle), std::sin(angle)) + Vector2d(100, -7));
    }
    expect_covers(star);
  }
}

TEST(Triangulate, ASquareWithAHoleJoinedToItsEdge) {
  expect_covers(
      {{-3, -3}, {3, -3}, {3, 0}, {1, 0}, {0, -1}, {-1, 0}, {0, 1}, {1, 0}, {3, 0}, {3, 3}, {-3, 3}});
}

TEST(Triangulate, NothingOfLessThanThreeCorners) {
  EXPECT_TRUE(triangulate({}).empty());
  EXPECT_TRUE(triangulate({{0, 0}, {1, 1}}).empty());
}

}  // namespace
}  // namespace hybrid_sphere::ros_interface
