#pragma once

#include "hybrid_sphere/scene/scene.hpp"

/// Where a point lies, found without any code of the library: the reference of the tests.
namespace hybrid_sphere::testing {

/// Whether a point lies in a shape; one on its edge may be on either side.
bool holds(const scene::Shape& shape, const Vector2d& point);

/// Number of the topmost region that holds a point; -1 for the base. A point on an edge may be on either
/// side.
int region_at(const scene::Surface& surface, const Vector2d& point);

/// From a point to the nearest place of a region's edge [m].
double distance_to_edge(const scene::Shape& shape, const Vector2d& point);

/// From a point to the nearest edge of the map [m].
double distance_to_edge(const scene::Surface& surface, const Vector2d& point);

}  // namespace hybrid_sphere::testing
