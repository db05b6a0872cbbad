// What of a region is drawn, against the region itself: areas, and points at random.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>
#include <tuple>

#include "ground/ground.hpp"
#include "interrupt/interrupt.hpp"
#include "ros/markers/ball_mesh.hpp"
#include "ros/markers/surface_labels.hpp"
#include "ros/markers/surface_markers.hpp"
#include "ros/markers/top_grid.hpp"
#include "support/patience.hpp"

namespace hybrid_sphere::ros_interface::outline_test {
namespace {

using visualization_msgs::Marker;

const std::vector<Vector2d> arrow{{0, 0}, {4, 1}, {1, 1.5}, {0.5, 4}};

scene::Surface surface_of(scene::Shape shape) {
  return {scene::Law::smooth, {{"region", std::move(shape), scene::Law::rough}}};
}

int count_triangles_at(const std::vector<Vector2d>& triangles, const Vector2d& p) {
  const auto left_of = [&p](const Vector2d& a, const Vector2d& b) {
    return (b.x() - a.x()) * (p.y() - a.y()) > (b.y() - a.y()) * (p.x() - a.x());
  };
  int count = 0;
  for (std::size_t i = 0; i < triangles.size(); i += 3) {
    const Vector2d& a = triangles[i];
    const Vector2d& b = triangles[i + 1];
    const Vector2d& c = triangles[i + 2];
    count += left_of(a, b) && left_of(b, c) && left_of(c, a) ? 1 : 0;
  }
  return count;
}

class Outlines : public ::testing::TestWithParam<scene::Shape> {};

TEST_P(Outlines, CoverTheRegionOnceAndNothingElse) {
  const scene::Surface surface = surface_of(GetParam());
  const ViewSquare view = view_around(surface, {Vector2d(-2, 1)}, 0.1);
  const Outline outline = outline_of(GetParam(), view);
  EXPECT_FALSE(outline.edges.empty());
  for (const Vector2d& corner : outline.triangles) {
    EXPECT_LE((corner - view.center).lpNorm<Eigen::Infinity>(), view.half * (1 + 1e-12));
  }
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> part(-1, 1);
  int wrong = 0;
  constexpr int points = 20000;
  for (int i = 0; i < points; ++i) {
    const Vector2d p = view.center + view.half * Vector2d(part(engine), part(engine));
    const int wanted = locate(GetParam(), p) == Side::inside ? 1 : 0;
    wrong += count_triangles_at(outline.triangles, p) != wanted ? 1 : 0;
  }
  // Of a circle drawn with 96 sides a part of 7e-4 of its area is missing.
  EXPECT_LE(wrong, std::holds_alternative<scene::Circle>(GetParam()) ? points / 1000 : 0);
}

INSTANTIATE_TEST_SUITE_P(EveryShape, Outlines,
                         ::testing::Values(scene::HalfPlane{{0, 0}, {1, 0}},
                                           scene::HalfPlane{{3, 1}, {-0.2, 5}},
                                           scene::HalfPlane{{3, 1}, {-1, -1}},
                                           scene::Circle{{1, 2}, 3, false}, scene::Circle{{1, 2}, 3, true},
                                           scene::Circle{{9, -2}, 0.5, true}, scene::Polygon{arrow, false},
                                           scene::Polygon{arrow, true}));

TEST(ViewSquare, HoldsAllThatIsFinite) {
  scene::Surface surface = surface_of(scene::Circle{{10, 0}, 2, false});
  surface.regions.push_back({"edge", scene::HalfPlane{{0, -7}, {0, 1}}, scene::Law::rough});
  const ViewSquare view = view_around(surface, {Vector2d(-3, 1), Vector2d(0, 20)}, 0.5);
  for (const Vector2d& p : {Vector2d(12, 0), Vector2d(0, -7), Vector2d(-3, 1), Vector2d(0, 20)}) {
    EXPECT_TRUE(view.contains(p)) << p.transpose();
  }
}

TEST(Labels, StandWhereTheirGroundIsOnTop) {
  scene::Surface surface = surface_of(scene::HalfPlane{{0, 0}, {1, 0}});
  surface.regions.push_back({"lake", scene::Circle{{3, 0}, 1, false}, scene::Law::smooth});
  surface.regions.push_back({"tiny", scene::Circle{{-2, 0}, 1e-6, false}, scene::Law::smooth});
  surface.regions.push_back({"hidden", scene::Circle{{5, 5}, 1e-6, false}, scene::Law::smooth});
  surface.regions.push_back({"cover", scene::Circle{{5, 5}, 1, false}, scene::Law::rough});
  const ViewSquare view = view_around(surface, {Vector2d(-3, 0)}, 0.1);
  const std::vector<Label> labels = find_labels(Ground(surface), view);
  ASSERT_EQ(labels.size(), 6U);
  const Ground ground(surface);
  for (std::size_t i : {0U, 1U, 2U, 4U}) {
    EXPECT_TRUE(labels[i].visible) << i;
    EXPECT_EQ(ground.top_region(labels[i].position), static_cast<RegionId>(i));
  }
  EXPECT_FALSE(labels[3].visible);
  EXPECT_EQ(ground.top_region(labels[5].position), base_region);
}

TEST(SurfaceMarkers, SayNameAndLawOfEveryRegion) {
  scene::Surface surface = surface_of(scene::Polygon{arrow, true});
  surface.regions.push_back({"disc", scene::Circle{{2, 1}, 0.4, false}, scene::Law::smooth});
  const ViewSquare view = view_around(surface, {Vector2d(0, 0)}, 0.1);
  const auto array = surface_markers(Ground(surface), view, 0.1, "map");
  EXPECT_EQ(array.markers.front().action, Marker::DELETEALL);
  std::set<std::string> texts;
  std::set<double> heights;
  for (const Marker& marker : array.markers) {
    EXPECT_EQ(marker.header.frame_id, "map");
    if (marker.type == Marker::TEXT_VIEW_FACING) texts.insert(marker.text);
    if (marker.ns == "regions") {
      for (const auto& corner : marker.points) heights.insert(corner.z);
    }
    EXPECT_EQ(marker.type == Marker::TRIANGLE_LIST, !marker.colors.empty());
    EXPECT_EQ(marker.colors.empty() ? 0 : marker.points.size(), marker.colors.size());
  }
  EXPECT_EQ(texts, (std::set<std::string>{"base: smooth", "region: rough", "disc: smooth"}));
  EXPECT_EQ(heights.size(), 3U);  // of base, region, disc
  EXPECT_LT(*heights.rbegin(), 0);
}

/// Height of the first corner of the marker of a law.
double height_of(const visualization_msgs::MarkerArray& array, scene::Law law) {
  for (const Marker& marker : array.markers) {
    if (marker.ns == "regions" && marker.id == static_cast<int>(law)) return marker.points.front().z;
  }
  return 1;
}

TEST(SurfaceMarkers, LaterRegionsLieHigherAndEveryLawHasItsColour) {
  scene::Surface surface = surface_of(scene::HalfPlane{{0, 0}, {1, 0}});  // rough
  surface.regions.push_back({"mat", scene::Circle{{2, 1}, 0.4, false}, scene::Law::rubber});
  surface.regions.push_back({"ice", scene::Circle{{2, 1}, 0.2, false}, scene::Law::coulomb});
  const auto array =
      surface_markers(Ground(surface), view_around(surface, {Vector2d(0, 0)}, 0.1), 0.1, "map");
  double below = -1;
  for (const scene::Law law :
       {scene::Law::smooth, scene::Law::rough, scene::Law::rubber, scene::Law::coulomb}) {
    const double height = height_of(array, law);
    EXPECT_GT(height, below);
    EXPECT_LT(height, 0);
    below = height;
  }
  std::set<std::tuple<float, float, float>> colors;
  for (const Marker& marker : array.markers) {
    if (marker.ns == "regions") colors.insert({marker.color.r, marker.color.g, marker.color.b});
  }
  EXPECT_EQ(colors.size(), 4U);
}

TEST(SurfaceMarkers, TenThousandRegionsAreFewMarkers) {
  scene::Surface surface;
  for (int i = 0; i < 10000; ++i) {
    surface.regions.push_back({std::to_string(i),
                               scene::Circle{{3. * (i % 100), 3 * std::floor(i / 100.)}, 1, false},
                               i % 2 == 0 ? scene::Law::rough : scene::Law::coulomb});
  }
  const ViewSquare view = view_around(surface, {Vector2d(0, 0)}, 0.1);
  const auto array = surface_markers(Ground(surface), view, 0.1, "map");
  EXPECT_LT(array.markers.size(), 200U);
  std::size_t points = 0;
  for (const Marker& marker : array.markers) points += marker.points.size();
  EXPECT_LT(points, 1'000'000U);
  EXPECT_GT(points, 10'000U * 12 * 3);  // every disc is filled
}

/// A polygon with so many corners around the origin, at distances from 1 to 3.
scene::Polygon star(std::size_t corners) {
  scene::Polygon polygon;
  std::mt19937 engine(2);
  std::uniform_real_distribution<double> distance(1, 3);
  for (std::size_t i = 0; i < corners; ++i) {
    const double angle = 2 * 3.14159265358979 * static_cast<double>(i) / static_cast<double>(corners);
    polygon.vertices.push_back(distance(engine) * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return polygon;
}

TEST(SurfaceMarkers, PolygonsOfManyCornersAreFilled) {
  const scene::Polygon polygon = star(5000);
  const ViewSquare view = view_around(surface_of(polygon), {Vector2d(0, 0)}, 0.1);
  EXPECT_EQ(outline_of(polygon, view).triangles.size() / 3, 4998U);
  EXPECT_EQ(outline_of(polygon, view).edges.size(), 10000U);
  Detail detail;
  detail.fills = false;
  EXPECT_TRUE(outline_of(polygon, view, detail).triangles.empty());
  EXPECT_EQ(outline_of(polygon, view, detail).edges.size(), 10000U);
}

// Each corner passes an interruption point in the triangulation and another one in the grid, and each 256th
// of them asks. A look at each corner for each cell of the grid passes none.
TEST(SurfaceMarkers, APolygonOfAMillionCornersIsDrawn) {
  const Ground ground(surface_of(star(1'000'000)));
  const testing::HangGuard guard;
  std::uint64_t questions = 0;
  const ShouldStop count = [&] { return ++questions == 0; };
  const InterruptScope scope(count);
  const auto array =
      surface_markers(ground, view_around(ground.surface(), {Vector2d(0, 0)}, 0.1), 0.1, "map");
  std::size_t points = 0;
  for (const Marker& marker : array.markers) points += marker.points.size();
  EXPECT_GT(points, 4'999'000U);
  EXPECT_NEAR(256.0 * static_cast<double>(questions), 2e6, 1e5);
}

TEST(SurfaceMarkers, AreFiniteHoweverSlowOrFastTheGroundMoves) {
  for (const double speed : {5e-324, 1e-310, 1e-200, 1e-160, 1e-30, 1., 1e15}) {
    scene::Surface surface = surface_of(scene::HalfPlane{{0, 0}, {1, 0}});
    surface.regions[0].material.belt = {speed, -speed};
    surface.regions.push_back({"table", scene::Circle{{-3, 0}, 2, false}, scene::Law::rough});
    surface.regions[1].material.turntable_rate = -speed;
    surface.regions[1].material.turntable_center = {-3, 0};
    const Ground ground(surface);
    const ViewSquare view = view_around(surface, {Vector2d(0, 0)}, 0.1);
    bool moves = false;
    for (const Marker& marker : surface_markers(ground, view, 0.1, "map").markers) {
      moves = moves || marker.ns == "motion";
      for (const auto& p : marker.points) {
        ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) << speed << marker.ns;
      }
    }
    EXPECT_TRUE(moves) << speed;
  }
}

TEST(TopGrid, SaysWhatTheGroundSays) {
  scene::Surface surface = surface_of(scene::HalfPlane{{0.3, 0}, {1, 0.2}});
  surface.regions.push_back({"star", star(500), scene::Law::smooth});
  surface.regions.push_back({"disc", scene::Circle{{2, 1}, 0.7, false}, scene::Law::rubber});
  surface.regions.push_back({"arrow", scene::Polygon{arrow, false}, scene::Law::rubber});
  scene::Polygon sea = star(300);
  for (Vector2d& corner : sea.vertices) corner *= 1.5;
  sea.outside = true;
  surface.regions.push_back({"sea", sea, scene::Law::smooth});
  surface.regions.push_back({"far", scene::Circle{{50, 50}, 1, false}, scene::Law::rubber});
  const Ground ground(surface);
  for (const ViewSquare& view :
       {ViewSquare{{0.1, 0.2}, 7}, ViewSquare{{2, 0}, 0.5}, ViewSquare{{-90, 3}, 200}}) {
    const TopGrid grid(ground, view, 60);
    for (int row = 0; row < grid.side(); ++row) {
      for (int column = 0; column < grid.side(); ++column) {
        const Vector2d center = grid.center(row, column);
        ASSERT_EQ(grid.top(row, column), ground.top_region(center)) << center.transpose();
      }
    }
  }
}

TEST(BallMesh, IsAClosedSphereOfItsRadius) {
  constexpr double radius = 0.4;
  double volume = 0;
  for (const Marker& part : ball_markers({"world", "ball"}, radius).markers) {
    EXPECT_EQ(part.header.frame_id, "ball");
    EXPECT_TRUE(part.frame_locked);
    for (std::size_t i = 0; i < part.points.size(); i += 3) {
      Eigen::Matrix3d corners;
      for (int j = 0; j < 3; ++j) {
        const auto& p = part.points[i + static_cast<std::size_t>(j)];
        corners.col(j) << p.x, p.y, p.z;
        EXPECT_NEAR(corners.col(j).norm(), radius, 1e-15);
      }
      volume +=
          corners.determinant() / 6;  // positive where the corners run counter-clockwise seen from outside
    }
  }
  EXPECT_NEAR(volume / (4. / 3 * 3.14159265358979 * radius * radius * radius), 1, 0.015);
}

}  // namespace
}  // namespace hybrid_sphere::ros_interface::outline_test
