#pragma once

#include <optional>
#include <utility>

#include "ground/ground.hpp"
#include "hybrid_sphere/sphere/sphere.hpp"
#include "simulation/segment.hpp"

namespace hybrid_sphere {

/// An edge between two grounds, with one of them on each side.
struct SharedEdge {
  Contact piece{no_region, {}};
  RegionId first = no_region;
  RegionId second = no_region;
  Vector2d normal = Vector2d::Zero();  ///< of length 1, into the first
};

/// The edges on which the sphere is where something changes, and what meets there.
class EdgeContacts {
 public:
  /// Makes room for those of a ground.
  void reserve(const Ground& ground);
  /// Exchanges the ground; the contacts are those of the one before until clear() or assign().
  /// @param ground  has to live as long as this
  void set_ground(const Ground& ground) { ground_ = &ground; }

  const Contacts& all() const { return contacts_; }
  void clear() { contacts_.clear(); }
  void assign(const Contacts& contacts) { contacts_.assign(contacts.begin(), contacts.end()); }
  /// Leaves this one alone. @return those before
  Contacts exchange(const Contact& contact) { return std::exchange(contacts_, {contact}); }

  /// Adds the edges of a region on which a place exactly is, where none of it is known.
  void add(RegionId region, const Vector2d& position);
  /// The same for all regions whose edges are seen at a place.
  void add_seen_at(const Vector2d& position);
  /// Adds all pieces of the edges that are seen at a place, whether known or not.
  void add_pieces_seen_at(const Vector2d& position);
  /// Adds the corner of a region in a place or, where it has none there, as add() does.
  void add_corner(RegionId region, const Vector2d& corner);

  /// The end of a side from which rounding does not tell a place is the place: from a corner a straight path
  /// and a curved one lead into the same ground, within rounding of it they need not.
  /// @param motion  that led there
  /// @param way     whose rounding the place has [m]
  void snap_to_corners(const Motion& motion, double way, Vector2d& position);

  /// Whether edges of several directions meet where the sphere is.
  bool in_corner() const;

  /// The straight edge between two regions on which the sphere is.
  std::optional<SharedEdge> edge_between(RegionId first, RegionId second, const Vector2d& position) const;

  /// The edge between two grounds that leads away from a place in the direction in which the sphere would
  /// slide along it, thrown from one to the other. Source: docs/theory.md 5.4.
  std::optional<SharedEdge> edge_ahead(RegionId first, RegionId second, const Sphere& sphere,
                                       const Segment::Start& state) const;

  /// The path runs along an edge: along the pieces of it of the two grounds on one line.
  void follow(const SharedEdge& edge);

 private:
  bool is_like(RegionId region, const scene::Material& material) const;
  double part_aside(const Vector2d& place, const Vector2d& ahead, double step) const;

  const Ground* ground_ = nullptr;
  Contacts contacts_;
};

}  // namespace hybrid_sphere
