#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "hybrid_sphere/scene/scene.hpp"

namespace hybrid_sphere::ros_interface {

/// The part of the plane that is drawn, a square with sides along the axes of the world frame [m].
struct ViewSquare {
  Vector2d center;
  double half;  ///< half the length of a side

  bool contains(const Vector2d& point) const { return (point - center).lpNorm<Eigen::Infinity>() <= half; }
  std::vector<Vector2d> corners() const;  ///< counter-clockwise, from the lower left
};

/// A square with a margin around the sphere, where it is and where it started, and all that is finite in the
/// surface.
ViewSquare view_around(const scene::Surface& surface, const std::vector<Vector2d>& positions, double radius);

/// The smallest box of axes around the edges of a circle or a polygon, at z = 0 [m]; empty for a half-plane.
Eigen::AlignedBox3d bounded_extent(const scene::Shape& shape);
/// The smallest box of axes around all edges of circles and polygons, at z = 0 [m]; empty if there are none.
Eigen::AlignedBox3d bounded_extent(const scene::Surface& surface);

/// A region as it is drawn, in the world frame [m].
struct Outline {
  std::vector<Vector2d>
      triangles;  ///< three corners each, counter-clockwise: what of the region lies in the square
  std::vector<Vector2d> edges;  ///< two ends a line: the edge of the region
};

/// How finely regions are drawn.
struct Detail {
  int circle_sides = 96;
  bool fills = true;  ///< false: polygons are drawn by their edge alone
};

/// @param view  has all that is finite in the region inside it
Outline outline_of(const scene::Shape& shape, const ViewSquare& view, const Detail& detail = {});

}  // namespace hybrid_sphere::ros_interface
