#pragma once

#include <optional>
#include <vector>

#include "html/cell_raster.hpp"
#include "html/rings.hpp"

namespace hybrid_sphere::html {

struct DrawnRegion {
  std::size_t region;  ///< index in the surface
  std::vector<Ring> rings;
};

/// What of the ground a page draws: that around the path, and of very many regions those nearest to it.
struct DrawnGround {
  Drawing drawing;
  Vector2d extent;  ///< half the sides of the rectangle around the origin that shows the path [m]
  double view = 0;  ///< the longer one of them [m]
  std::optional<CellRaster> cells;
  std::vector<DrawnRegion> regions;  ///< later ones lie over earlier ones, all over the cells
  std::size_t left_out = 0;          ///< regions in the drawing for which there was no room
  std::size_t beyond = 0;            ///< bounded regions outside of it
};

/// @param path    places along it; not empty [m]
/// @param radius  of the sphere [m]
/// @param room    bytes that it may take on the page
DrawnGround draw_ground(const scene::Surface& surface, const std::vector<Vector2d>& path, double radius,
                        std::size_t room);

}  // namespace hybrid_sphere::html
