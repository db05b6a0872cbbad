#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "hybrid_sphere/scene/scene.hpp"
#include "scene/map_reader.hpp"

namespace hybrid_sphere::scene {

inline constexpr Range resolution_range{1e-12, 1e15, "[m]"};
inline constexpr std::size_t max_cells = 16U << 20U;
inline constexpr std::size_t max_cell_regions = 1U << 20U;

/// Square cells, each of which belongs to the region or not.
struct CellMap {
  std::size_t width = 0;                ///< cells along x
  std::size_t height = 0;               ///< cells along y
  double resolution = 0;                ///< side of a cell [m]
  Vector2d origin = Vector2d::Zero();   ///< lower left corner of the first cell [m]
  std::vector<std::uint8_t> belonging;  ///< not 0: belongs; row by row from the lowest, each by growing x
  Vector2d axis = Vector2d::UnitX();    ///< direction of the rows, a unit vector: (1, 0) unless turned
};

/// The cells that belong, as few rectangles: runs along x, equal runs of neighbouring rows joined. The
/// corners lie at origin + i resolution of these numbers as they are written, to the nearest number: -0.7 and
/// 0.1 have a line at -0.4. Neighbours share the coordinates of their edge to the bit. Turned rectangles have
/// more corners: see cell_map.cpp.
/// @param prefix  of the names, which go on with 0, 1, 2 ... by growing y, then x of the lower left corner
/// @param path    put before the fields in error messages
/// @throws SceneError  for no cells, more than max_cells, more rectangles than max_cell_regions, a
///                     resolution that is out of range or lost in the coordinates' rounding
std::vector<Region> regions_of(const CellMap& cells, const Material& material, const std::string& prefix,
                               const std::string& path);

}  // namespace hybrid_sphere::scene
