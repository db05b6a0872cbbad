#pragma once

#include <Eigen/Core>
#include <vector>

namespace hybrid_sphere::ros_interface {

/// Cuts a polygon into triangles by clipping ears; signs of areas are exact, the time is quadratic in the
/// corners.
/// @param corners  of a simple polygon, counter-clockwise; two of its sides may lie over each other in
/// opposite
///                 directions, as where a hole is joined to the outer edge
/// @return         three corners a triangle, counter-clockwise; together they cover the polygon once
std::vector<Eigen::Vector2d> triangulate(std::vector<Eigen::Vector2d> corners);

}  // namespace hybrid_sphere::ros_interface
