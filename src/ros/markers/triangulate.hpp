#pragma once

#include <Eigen/Core>
#include <vector>

namespace hybrid_sphere::ros_interface {

/// Cuts a polygon, or one with holes, into triangles, by a sweep that cuts it into monotone pieces; signs of
/// areas are exact, the time is n log n in the corners. Source: de Berg et al., Computational Geometry, 3.2
/// and 3.3.
/// @param rings  closed lines that neither meet nor touch themselves or each other; what is to be covered
/// lies
///               left of every side
/// @return       three corners a triangle, counter-clockwise; together they cover it once. Of what is no such
///               region, nothing
std::vector<Eigen::Vector2d> triangulate(const std::vector<std::vector<Eigen::Vector2d>>& rings);

}  // namespace hybrid_sphere::ros_interface
