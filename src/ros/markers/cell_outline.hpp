#pragma once

#include <vector>

#include "ground/ground.hpp"

namespace hybrid_sphere::ros_interface {

/// The regions of a surface that are made of cells (Surface::image_regions), as they are drawn: what hangs
/// together is one piece of ground, with one edge and one name. Cells hang together where they share a piece
/// of a side; those that touch at a corner alone do not.
struct CellOutline {
  std::vector<Vector2d> edges;    ///< two ends a line: where cells border on other ground [m]
  std::vector<RegionId> leaders;  ///< by region, the first one of its piece; of other regions themselves
};

/// In n log n of the regions.
CellOutline cell_outline(const scene::Surface& surface);

}  // namespace hybrid_sphere::ros_interface
