#pragma once

#include <vector>

#include "hybrid_sphere/scene/scene.hpp"

namespace hybrid_sphere::html {

/// Corners of a closed line [m].
using Ring = std::vector<Vector2d>;

/// A rectangle with sides along the axes [m].
struct Rectangle {
  Vector2d low;
  Vector2d high;

  Ring corners() const;  ///< counter-clockwise
  Rectangle grown(double by) const { return {low.array() - by, high.array() + by}; }
  Rectangle moved(const Vector2d& by) const { return {low + by, high + by}; }
  bool meets(const Rectangle& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
};

/// How regions are drawn, relative to an origin near the path.
struct Drawing {
  Vector2d origin;
  Rectangle inside;  ///< what is drawn, relative to the origin [m]
  double tolerance;  ///< how far a drawn edge may be from the true one [m]
};

/// What of a region lies in the drawing, relative to its origin: an outline, and holes in it. Empty: nothing.
std::vector<Ring> rings_of(const scene::Shape& shape, const Drawing& drawing);

/// About as many corners as rings_of gives, without computing them.
std::size_t corners_of(const scene::Shape& shape, const Drawing& drawing);

/// The rectangle around a circle or a polygon, also of one that is left out of its region; of a half-plane
/// the whole plane.
Rectangle box_of(const scene::Shape& shape);

}  // namespace hybrid_sphere::html
