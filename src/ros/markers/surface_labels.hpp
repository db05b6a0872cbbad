#pragma once

#include <vector>

#include "ground/ground.hpp"
#include "ros/markers/surface_outline.hpp"

namespace hybrid_sphere::ros_interface {

/// Where the name of a region is written.
struct Label {
  Vector2d position;  ///< in the world frame [m]
  double room;        ///< distance from there to other ground, or to the edge of the square; bounded [m]
  bool visible;       ///< false: no place was found where the region is on top
};

/// A point that stands for a shape: of its edge, its centre, or the mean of its corners [m].
Vector2d middle_of(const scene::Shape& shape);

/// For each region, and last for the base, the place in the square that is farthest from all other ground;
/// of several the one with most room to its left and right, and then the one nearest to the middle. Looked
/// for on a grid that gets coarser with the number of regions, so that the time is bounded; what is too small
/// for the grid has its name in its middle, unless the regions are very many.
/// @param leaders  by region the one that it hangs together with and whose name stands for both, itself or an
///                 earlier one (CellOutline); empty: each stands for itself
std::vector<Label> find_labels(const Ground& ground, const ViewSquare& view,
                               const std::vector<RegionId>& leaders = {});

}  // namespace hybrid_sphere::ros_interface
