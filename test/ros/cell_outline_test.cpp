// Cells of images and grids: what is drawn of them borders on other ground.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "ground/ground.hpp"
#include "ros/markers/cell_outline.hpp"
#include "ros/markers/surface_markers.hpp"
#include "scene/cell_map.hpp"

namespace hybrid_sphere::ros_interface::cell_outline_test {
namespace {

using visualization_msgs::Marker;

/// Cells of 1 m, each of which belongs by chance.
scene::CellMap random_cells(std::size_t side, double share, unsigned seed) {
  std::mt19937 engine(seed);
  std::bernoulli_distribution belongs(share);
  scene::CellMap cells{side, side, 1, {0, 0}, std::vector<std::uint8_t>(side * side)};
  for (std::uint8_t& cell : cells.belonging) cell = belongs(engine) ? 1 : 0;
  return cells;
}

scene::Surface surface_of(const scene::CellMap& cells) {
  scene::Surface surface;
  surface.regions = scene::regions_of(cells, scene::Law::rough, "cell_", "cells");
  surface.image_regions = surface.regions.size();
  return surface;
}

bool belongs(const scene::CellMap& cells, double x, double y) {
  const auto side = static_cast<double>(cells.width);
  if (x < 0 || y < 0 || x >= side || y >= side) return false;
  return cells.belonging[static_cast<std::size_t>(y) * cells.width + static_cast<std::size_t>(x)] != 0;
}

/// Names every cell by the first one, row by row, that it hangs together with.
std::vector<std::size_t> flooded(const scene::CellMap& cells) {
  const std::size_t n = cells.width;
  std::vector<std::size_t> names(n * n, n * n);
  for (std::size_t first = 0; first < n * n; ++first) {
    std::vector<std::size_t> open{first};
    while (!open.empty()) {
      const std::size_t i = open.back();
      open.pop_back();
      if (cells.belonging[i] == 0 || names[i] < n * n) continue;
      names[i] = first;
      if (i % n > 0) open.push_back(i - 1);
      if (i % n + 1 < n) open.push_back(i + 1);
      if (i >= n) open.push_back(i - n);
      if (i + n < n * n) open.push_back(i + n);
    }
  }
  return names;
}

TEST(CellOutline, RunsWhereCellsBorderOnOtherGroundAndNowhereElse) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const scene::CellMap cells = random_cells(24, 0.05 * (seed + 1), seed);
    const std::vector<Vector2d> edges = cell_outline(surface_of(cells)).edges;
    ASSERT_EQ(edges.size() % 2, 0U);
    double length = 0;
    for (std::size_t i = 0; i < edges.size(); i += 2) {
      const Vector2d along = edges[i + 1] - edges[i];
      ASSERT_EQ(along.cwiseAbs().minCoeff(), 0);
      length += along.norm();
      const Vector2d across = 0.5 * Vector2d(along.y(), along.x()).cwiseAbs().normalized();
      for (double at = 0.5; at < along.norm(); ++at) {  // the middle of each cell's side
        const Vector2d p = edges[i] + at * along.normalized();
        EXPECT_NE(belongs(cells, p.x() - across.x(), p.y() - across.y()),
                  belongs(cells, p.x() + across.x(), p.y() + across.y()))
            << p.transpose();
      }
    }
    double wanted = 0;
    for (double y = -0.5; y < 24; ++y) {
      for (double x = -0.5; x < 24; ++x) {
        wanted += belongs(cells, x, y) != belongs(cells, x + 1, y) ? 1 : 0;
        wanted += belongs(cells, x, y) != belongs(cells, x, y + 1) ? 1 : 0;
      }
    }
    EXPECT_EQ(length, wanted);
  }
}

TEST(CellOutline, JoinsWhatHangsTogetherAndNoMore) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const scene::CellMap cells = random_cells(24, 0.05 * (seed + 1), seed);
    const std::vector<std::size_t> names = flooded(cells);
    const scene::Surface surface = surface_of(cells);
    const std::vector<RegionId> leaders = cell_outline(surface).leaders;
    ASSERT_EQ(leaders.size(), surface.regions.size());
    std::set<std::pair<std::size_t, RegionId>> pairs;
    std::set<std::size_t> pieces;
    std::set<RegionId> of_leaders;
    for (std::size_t i = 0; i < leaders.size(); ++i) {
      const Vector2d& corner = std::get<scene::Polygon>(surface.regions[i].shape).vertices.front();
      const std::size_t piece =
          names[static_cast<std::size_t>(corner.y()) * 24 + static_cast<std::size_t>(corner.x())];
      EXPECT_LE(leaders[i], static_cast<RegionId>(i));
      pairs.emplace(piece, leaders[i]);
      pieces.insert(piece);
      of_leaders.insert(leaders[i]);
    }
    EXPECT_EQ(pairs.size(), pieces.size());
    EXPECT_EQ(pairs.size(), of_leaders.size());
  }
}

TEST(SurfaceMarkers, DrawNoEdgeAndNoNameInsideOfCellsThatHangTogether) {
  scene::CellMap cells{3, 2, 1, {0, 0}, {1, 1, 1, 1, 0, 0}};  // two rectangles, one piece
  scene::Surface surface = surface_of(cells);
  ASSERT_EQ(surface.regions.size(), 2U);
  surface.regions.push_back({"disc", scene::Circle{{5, 1}, 0.5, false}, scene::Law::smooth});
  const auto array =
      surface_markers(Ground(surface), view_around(surface, {Vector2d(1, 1)}, 0.1), 0.1, "map");
  std::set<std::string> texts;
  double length = 0;
  for (const Marker& marker : array.markers) {
    if (marker.type == Marker::TEXT_VIEW_FACING) texts.insert(marker.text);
    if (marker.ns != "edges") continue;
    for (std::size_t i = 0; i < marker.points.size(); i += 2) {
      const auto& a = marker.points[i];
      const auto& b = marker.points[i + 1];
      if (a.x <= 3 && b.x <= 3) length += std::hypot(b.x - a.x, b.y - a.y);
    }
  }
  EXPECT_EQ(length, 3 + 1 + 2 + 1 + 1 + 2);
  EXPECT_EQ(texts, (std::set<std::string>{"base: smooth", "cell_0: rough", "disc: smooth"}));
}

}  // namespace
}  // namespace hybrid_sphere::ros_interface::cell_outline_test
