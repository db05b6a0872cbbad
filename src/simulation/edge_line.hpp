#pragma once

#include <cfloat>
#include <optional>

#include "ground/crossing.hpp"

namespace hybrid_sphere {

/// Of the place: the search for the return does not see an excursion from an edge that is smaller. It begins
/// 8 sqrt(noise/acceleration) after the start, with 4 roundings in the noise (trace_curve.cpp).
inline constexpr double unseen = 64 * DBL_EPSILON;

/// The line of a straight piece of edge.
struct EdgeLine {
  Vector2d point;
  Vector2d direction;  ///< not of length 1
};

/// Empty for a circle or a corner.
std::optional<EdgeLine> line_of(const scene::Shape& shape, const EdgePiece& piece);

/// Whether two lines are parallel, to within rounding.
bool are_parallel(const EdgeLine& a, const EdgeLine& b);

/// An edge at a place on it: its unit normal, into the region, and its curvature, positive where the region
/// lies on the outer side of the bend [1/m].
struct LocalEdge {
  Vector2d normal;
  double bend = 0;
};

/// Empty for a corner.
std::optional<LocalEdge> local_edge(const scene::Shape& shape, const EdgePiece& piece,
                                    const Vector2d& position);

/// From a place to the nearest point of a side [m].
double distance_to_side(const scene::Polygon& polygon, std::int32_t side, const Vector2d& position);

/// Size of the numbers that define an edge [m].
double size_of(const scene::Shape& shape);

/// The point of an edge nearest to a place beside it.
/// @param piece  no corner
Vector2d put_on_edge(const scene::Shape& shape, const EdgePiece& piece, const Vector2d& position);

/// A place where two edges touch without crossing, and the smaller of their radii.
struct Touch {
  Vector2d point;
  double radius;
};

/// Empty if both edges are lines, or if they do not touch to within `rounding`.
std::optional<Touch> touch_of(const scene::Shape& a, const EdgePiece& piece_a, const scene::Shape& b,
                              const EdgePiece& piece_b, double rounding);

/// Whether a point on the line of a straight edge is on the edge itself, to within `rounding`.
bool holds(const scene::Shape& shape, const EdgePiece& piece, const Vector2d& point, double rounding);

/// Where two straight edges meet; a corner or a point of a half-plane next to it is meant.
std::optional<Vector2d> corner_of(const scene::Shape& a, const EdgePiece& piece_a, const scene::Shape& b,
                                  const EdgePiece& piece_b, double rounding);

}  // namespace hybrid_sphere
