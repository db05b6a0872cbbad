#pragma once

#include <iosfwd>

#include "hybrid_sphere/scene/scene.hpp"

/// Random shapes and scenes on a coarse grid, so that ties (vertices on the path, tangents, common edges,
/// starts on edges) are frequent and exact.
namespace hybrid_sphere::testing {

/// From low to high, both included.
int integer(int low, int high);

/// Corners on the grid of integers within +-8.
Vector2d random_grid_point();

/// Components within +-4, not both 0.
Vector2d random_direction();

/// A half-plane, a circle, or a simple polygon of 3 to 8 corners, often concave; counter-clockwise.
scene::Shape random_shape();

/// Up to 8 regions of random shapes and laws.
scene::Surface random_surface();

/// A sphere on a random surface. All numbers are dyadic with few digits; the velocities are not small.
scene::Scene random_scene();

/// As in a scene file, for the log of a failed property.
std::ostream& operator<<(std::ostream& out, const scene::Shape& shape);
std::ostream& operator<<(std::ostream& out, const scene::Scene& scene);

}  // namespace hybrid_sphere::testing
