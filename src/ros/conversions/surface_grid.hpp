#pragma once

#include <nav_msgs/OccupancyGrid.h>

#include "hybrid_sphere/scene/scene.hpp"
#include "ros/conversions/planar_transform.hpp"

namespace hybrid_sphere::ros_interface {

/// A surface whose regions are the occupied cells of a grid, as rough ground; neighbouring cells are merged.
/// Unknown cells (-1) count as free. Paths of errors begin with "surface_grid".
/// @param to_world   takes coordinates of the grid's frame, which is not looked at, to those of the world
/// @param threshold  least occupancy of an occupied cell, 1 to 100
/// @param under      its base and its rule for livelocks are kept, its regions are not
/// @throws scene::SceneError  for a grid that is empty, tilted, not on the ground or of the wrong size
scene::Surface surface_from_grid(const nav_msgs::OccupancyGrid& grid, const PlanarTransform& to_world,
                                 double threshold, const scene::Surface& under);

}  // namespace hybrid_sphere::ros_interface
