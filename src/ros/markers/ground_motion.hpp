#pragma once

#include <vector>

#include "ground/ground.hpp"
#include "ros/markers/region_names.hpp"

namespace hybrid_sphere::ros_interface {

/// How the ground moves: arrows along its velocity u(r) on a grid over the square, the longest as long as a
/// cell of the grid. The grid stays where it is when the square grows, unless there are too many cells: then
/// they are twice as large. None runs under a name; each region that moves has one where there is room.
/// @param unit     the cells are a twelfth of it or more [m]; 0: half the side of the square
/// @return  two ends a line, in the world frame [m]: a shaft and two strokes of the tip for each arrow
std::vector<Vector2d> motion_arrows(const Ground& ground, const ViewSquare& view,
                                    const std::vector<RegionName>& names, double unit = 0);

}  // namespace hybrid_sphere::ros_interface
