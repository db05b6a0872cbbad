#include "ros/conversions/surface_grid.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <unordered_set>
#include <variant>

#include "scene/cell_map.hpp"
#include "scene/tree.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

using scene::SceneError;

constexpr const char* prefix = "grid_";  // of the regions' names
constexpr int unknown = -1;
constexpr int surely_occupied = 100;

void check_size(const nav_msgs::OccupancyGrid& grid) {
  const std::uint64_t cells = std::uint64_t{grid.info.width} * grid.info.height;
  if (std::max<std::uint64_t>(grid.data.size(), cells) > scene::max_cells) {
    throw SceneError("surface_grid.info",
                     "a map of " + std::to_string(grid.info.width) + " x " +
                         std::to_string(grid.info.height) + " cells with " +
                         std::to_string(grid.data.size()) + " values",
                     "up to " + std::to_string(scene::max_cells) + " cells");
  }
  if (grid.data.size() != cells) {
    throw SceneError("surface_grid.data", std::to_string(grid.data.size()) + " values",
                     std::to_string(cells) + ", width times height");
  }
}

std::vector<std::uint8_t> occupied(const std::vector<std::int8_t>& data, double threshold) {
  std::vector<std::uint8_t> cells(data.size());
  for (std::size_t i = 0; i < data.size(); ++i) {
    if (data[i] < unknown || data[i] > surely_occupied) {
      throw SceneError("surface_grid.data[" + std::to_string(i) + "]", std::to_string(data[i]),
                       "0 to 100, or -1 for unknown");
    }
    cells[i] = data[i] >= threshold ? 1 : 0;
  }
  return cells;
}

/// The corners of cells, from the origin, as numbers of cells.
struct Corner {
  std::uint64_t x;
  std::uint64_t y;
  bool operator==(const Corner& other) const { return x == other.x && y == other.y; }
};
struct CornerHash {
  std::size_t operator()(const Corner& corner) const {
    return std::hash<std::uint64_t>()((corner.y << 32U) ^ corner.x);
  }
};
using Corners = std::unordered_set<Corner, CornerHash>;

Corner corner_of(const Vector2d& vertex, double resolution) {
  const auto cells = [&](double way) { return static_cast<std::uint64_t>(std::llround(way / resolution)); };
  return {cells(vertex.x()), cells(vertex.y())};
}

/// Turned, a corner that lies on the side of a neighbour would come to lie beside it by rounding: where one
/// does, the side has a corner, too, at the same coordinates.
scene::Polygon turned(const scene::Polygon& cells, double resolution, const Corners& corners,
                      const PlanarTransform& to_world) {
  scene::Polygon polygon;
  const auto add = [&](const Corner& corner) {
    polygon.vertices.push_back(to_world.point(
        {static_cast<double>(corner.x) * resolution, static_cast<double>(corner.y) * resolution}));
  };
  for (std::size_t i = 0; i < cells.vertices.size(); ++i) {
    Corner corner = corner_of(cells.vertices[i], resolution);
    const Corner end = corner_of(cells.vertices[(i + 1) % cells.vertices.size()], resolution);
    add(corner);
    const auto step = [](std::uint64_t& from, std::uint64_t to) {
      if (from < to) ++from;
      if (from > to) --from;
    };
    for (;;) {
      step(corner.x, end.x);
      step(corner.y, end.y);
      if (corner == end) break;
      if (corners.count(corner) != 0) add(corner);
    }
  }
  return polygon;
}

std::vector<scene::Region> turned(const std::vector<scene::Region>& regions, double resolution,
                                  const PlanarTransform& to_world) {
  Corners corners;
  for (const scene::Region& region : regions) {
    for (const Vector2d& vertex : std::get<scene::Polygon>(region.shape).vertices)
      corners.insert(corner_of(vertex, resolution));
  }
  std::vector<scene::Region> result;
  result.reserve(regions.size());
  for (const scene::Region& region : regions) {
    const auto& cells = std::get<scene::Polygon>(region.shape);
    result.push_back({region.name, turned(cells, resolution, corners, to_world), region.material});
  }
  return result;
}

}  // namespace

scene::Surface surface_from_grid(const nav_msgs::OccupancyGrid& grid, const PlanarTransform& to_world,
                                 double threshold, const scene::Surface& under) {
  const PlanarTransform placed =
      to_world.after(PlanarTransform::from(grid.info.origin, "surface_grid.info.origin"));
  check_size(grid);
  scene::CellMap cells;
  cells.width = grid.info.width;
  cells.height = grid.info.height;
  cells.resolution = static_cast<double>(grid.info.resolution);
  if (placed.turns()) {
    for (const double coordinate : placed.shift())
      scene::read_number(coordinate, "surface_grid.info.origin", scene::coordinate_range);
  } else {
    cells.origin = placed.shift();
  }
  cells.belonging = occupied(grid.data, threshold);
  scene::Surface surface;
  surface.base = under.base;
  surface.livelock = under.livelock;
  surface.regions = scene::regions_of(cells, scene::Law::rough, prefix, "surface_grid.info");
  if (placed.turns()) surface.regions = turned(surface.regions, cells.resolution, placed);
  surface.image_regions = surface.regions.size();
  return surface;
}

}  // namespace hybrid_sphere::ros_interface
