#include "ros/conversions/surface_grid.hpp"

#include <algorithm>

#include "scene/cell_map.hpp"

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
  cells.origin = placed.shift();
  cells.axis = placed.direction(Vector2d::UnitX());
  cells.belonging = occupied(grid.data, threshold);
  scene::Surface surface;
  surface.base = under.base;
  surface.livelock = under.livelock;
  surface.regions = scene::regions_of(cells, scene::Law::rough, prefix, "surface_grid.info");
  surface.image_regions = surface.regions.size();
  return surface;
}

}  // namespace hybrid_sphere::ros_interface
