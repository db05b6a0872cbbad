#pragma once

#include <optional>
#include <vector>

#include "ground/ground.hpp"
#include "simulation/segment.hpp"

namespace hybrid_sphere {

/// What a ground looks like from a place on its edge: a half-plane, or the sector of a corner.
struct Sector {
  std::vector<Vector2d> normals;  ///< unit normals of its sides, into it
  bool is_convex = true;          ///< it is inside of all its sides, not of any

  /// The other sector.
  Sector complement() const;
  /// Whether a vector points into it.
  /// @param rounding  of the vector's components
  bool contains(const Vector2d& vector, double rounding) const;
  /// Whether what lies in a direction from the place, and moves on with a velocity, is inside.
  bool is_entered(const Vector2d& direction, const Vector2d& velocity) const;

 private:
  template <class IsInside>
  bool is_inside(const IsInside& of_side) const;
};

/// An excursion over a ground that is too short to show in the place of the sphere.
struct HiddenExcursion {
  double end;     ///< of it, since it began [s]
  RegionId next;  ///< which the sphere reaches then
  Sector over;    ///< in which it has been
};

/// The excursion of a sphere that comes to a ground on an edge with a small velocity and is taken out of it
/// again by its acceleration: after 2 v/a, over the edge that comes first or, around a reflex corner, last.
/// Source: docs/theory.md 5.5.
/// @param contacts      of its place
/// @param left          the ground
/// @param next          into which its acceleration leads
/// @param acceleration  of the centre over the ground [m/s^2]
/// @return empty if there is none, it shows, or an edge is not straight
std::optional<HiddenExcursion> hidden_excursion(const Ground& ground, const Contacts& contacts, RegionId left,
                                                RegionId next, const Segment::Start& state,
                                                const Vector2d& acceleration);

}  // namespace hybrid_sphere
