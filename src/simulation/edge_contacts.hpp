#pragma once

#include <optional>
#include <utility>

#include "ground/ground.hpp"
#include "hybrid_sphere/sphere/sphere.hpp"
#include "simulation/edge_line.hpp"
#include "simulation/segment.hpp"

namespace hybrid_sphere {

/// An edge between two grounds, with one of them on each side.
struct SharedEdge {
  Contact piece{no_region, {}};
  RegionId first = no_region;
  RegionId second = no_region;
  Vector2d normal = Vector2d::Zero();  ///< of length 1, into the first
  double bend = 0;  ///< positive where the first is on the outer side of the bend [1/m]; 0 if straight

  LocalEdge seen_from(RegionId region) const {
    return region == first ? LocalEdge{normal, bend} : LocalEdge{-normal, -bend};
  }
};

/// The edges that the sphere is on at an instant, and the grounds that meet there.
class EdgeContacts {
 public:
  /// Reserves room for the contacts of a ground.
  void reserve(const Ground& ground);
  /// Replaces the ground; the contacts are those of the previous ground until clear() or assign().
  /// @param ground  must outlive this object
  void set_ground(const Ground& ground) { ground_ = &ground; }

  const Contacts& all() const { return contacts_; }
  void clear() { contacts_.clear(); }
  void assign(const Contacts& contacts) { contacts_.assign(contacts.begin(), contacts.end()); }
  /// Keeps only this contact. @return the previous contacts
  Contacts exchange(const Contact& contact) { return std::exchange(contacts_, {contact}); }

  /// Adds the edges of a region on which a place lies exactly, unless a contact with it is known.
  void add(RegionId region, const Vector2d& position);
  /// The same for all regions whose edges are visible at a place.
  void add_seen_at(const Vector2d& position);
  /// Adds all pieces of the edges that are visible at a place, whether known or not.
  void add_pieces_seen_at(const Vector2d& position);
  /// Adds the corner of a region at a place or, if there is none, does what add() does.
  void add_corner(RegionId region, const Vector2d& corner);

  /// For a velocity that leaves a ground along an edge, by no more than rounding across it: the unit normal
  /// of that edge, into the ground. Empty if there is no such edge, or several of different directions.
  /// @param rounding  of the velocity [m/s]
  std::optional<Vector2d> normal_of_rounded_exit(RegionId ground, const Vector2d& velocity,
                                                 double rounding) const;
  /// Whether a velocity leads out of a ground, or into the next one, over a side of it by more than rounding.
  bool leads_over(RegionId ground, RegionId next, const Vector2d& velocity, double rounding) const;
  /// Of all sides that are parallel to a velocity the path follows those from now on, whatever rounding says.
  void follow_along(const Vector2d& velocity, double rounding);
  /// The next motion follows no side.
  void follow_none();

  /// Adds the piece of a region's edge that is nearest to a place, if it is within rounding of it.
  /// @return whether it is
  bool add_nearest(RegionId region, const Vector2d& position);

  /// Moves a place that is within rounding of the end of a side to that end: from the corner itself, a
  /// straight path and a curved one lead into the same ground; from a place within rounding of it, they need
  /// not.
  /// @param motion  that led there
  /// @param way     whose rounding the place carries [m]
  void snap_to_corners(const Motion& motion, double way, Vector2d& position);

  /// Whether there are contacts, and a velocity crosses all of them by more than rounding.
  bool are_crossed(const Vector2d& velocity, double rounding) const;

  /// Whether an edge of a region is among the contacts.
  bool has(RegionId region) const;

  /// Whether edges of several directions meet where the sphere is.
  bool in_corner() const;

  /// The straight edge between two regions on which the sphere is.
  std::optional<SharedEdge> edge_between(RegionId first, RegionId second, const Vector2d& position) const;

  /// The edge between two grounds that leads away from a place in the direction in which the sphere would
  /// slide along it, thrown from one to the other. Source: docs/theory.md 5.4.
  std::optional<SharedEdge> edge_ahead(RegionId first, RegionId second, const Sphere& sphere,
                                       const Segment::Start& state) const;

  /// The path runs along an edge: follows the pieces of both grounds' edges on that line.
  void follow(const SharedEdge& edge);

 private:
  bool turn_along(const EdgeLine& line, Contact& contact) const;
  template <class Act>
  void for_each_side_along(const Vector2d& velocity, double rounding, const Act& act) const;
  bool is_like(RegionId region, const scene::Material& material) const;
  double part_aside(const Vector2d& place, const Vector2d& ahead, double step) const;

  const Ground* ground_ = nullptr;
  Contacts contacts_;
};

}  // namespace hybrid_sphere
