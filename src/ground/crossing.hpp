#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/exact.hpp"
#include "hybrid_sphere/scene/scene.hpp"

namespace hybrid_sphere {

/// Number of a region in its surface; later ones lie over earlier ones.
using RegionId = std::int32_t;
inline constexpr RegionId base_region = -1;
inline constexpr RegionId no_region = -2;

/// Side of a region's edge on which a path runs.
enum class Side : std::uint8_t { outside, edge, inside };

/// Motion of the centre between two switches: r(tau) = start + velocity tau, tau >= 0, in a unit of time in
/// which the larger component of the velocity is of order one.
struct Path {
  Vector2d start = Vector2d::Zero();
  Vector2d velocity = Vector2d::Zero();
  bool moves() const { return velocity.x() != 0 || velocity.y() != 0; }
};

/// The piece of a region's edge that a path meets.
struct EdgePiece {
  enum class Kind : std::uint8_t {
    line,           ///< the edge of a half-plane, or side `index` of a polygon
    vertex,         ///< corner `index` of a polygon
    circle_first,   ///< a circle, where the path comes to it
    circle_second,  ///< a circle, where the path leaves it
    circle_return,  ///< the same for a path that starts on the circle
  };
  Kind kind = Kind::line;
  std::int32_t index = 0;
};

/// A place where a path changes its side of a region's edge.
struct Crossing {
  double time = 0;   ///< tau > 0
  double error = 0;  ///< bound on the error of time
  RegionId region = 0;
  Side after = Side::outside;
  EdgePiece piece;          ///< what is met there
  std::int32_t along = -1;  ///< side of the polygon that is followed from there on, where after is Side::edge
  std::int8_t way = 0;      ///< 1 or -1: along or against the direction of a line that is run along both ways
  double doubt = 0;         ///< the error's bound, where crossings of one instant have agreed on their time
  bool joins = false;       ///< then: the one before is of the same instant
};

/// The edge on which a path starts, known from the event that began it: exact where the rounded position is
/// not.
struct Contact {
  RegionId region;
  EdgePiece piece;
  bool followed = false;  ///< the path runs along the piece, whatever rounding makes of its direction
};

/// Ascending by region.
using Contacts = std::vector<Contact>;

/// Those with a region's edge.
inline auto contacts_of(const Contacts& contacts, RegionId region) {
  constexpr std::size_t few = 8;
  const auto is_before = [](const Contact& contact, RegionId id) { return contact.region < id; };
  auto first = contacts.begin();
  if (contacts.size() > few) first = std::lower_bound(first, contacts.end(), region, is_before);
  while (first != contacts.end() && first->region < region) ++first;
  auto last = first;
  while (last != contacts.end() && last->region == region) ++last;
  return std::pair(first, last);
}

/// Inserts a contact behind those with the edge of the same region.
inline void insert(const Contact& contact, Contacts& contacts) {
  contacts.insert(contacts_of(contacts, contact.region).second, contact);
}

/// Side of a point that does not move.
Side locate(const scene::Shape& shape, const Vector2d& point);

/// What the time of a crossing, rounded to binary64, leaves out, to about as many digits again: for edges of
/// half-planes and sides of polygons, in the place where they are crossed; 0 for others.
double time_remainder(const Path& path, const scene::Shape& shape, const Crossing& crossing);

/// Order in time of two crossings of one path: -1, 0 or 1, decided exactly where the rounded times are too
/// close.
int compare(const Path& path, const scene::Shape& shape_a, const Crossing& a, const scene::Shape& shape_b,
            const Crossing& b);

/// Traces a path over a region: the side just after its start, and all changes of side after that.
/// No crossing is missed, however thin the region or flat the angle: which edges are crossed follows from
/// exact signs, and only the times are rounded.
/// @param contact    piece of this region's edge on which the path starts, or null when that is not known
/// beforehand
/// @param crossings  the changes are appended here, ascending in time
/// @param here       set to the piece of the edge that the path follows when the result is Side::edge
/// @param followed   the path lies on the contact's line, whatever rounding makes of its direction
Side trace(const Path& path, RegionId id, const scene::Shape& shape, const EdgePiece* contact,
           std::vector<Crossing>& crossings, EdgePiece& here, bool followed = false);

/// Most changes of side that trace can find.
std::size_t max_crossings(const scene::Shape& shape);

namespace detail {

/// @param shape  a Polygon
Side trace_polygon(const Path& path, RegionId id, const scene::Shape& shape, const EdgePiece* contact,
                   std::vector<Crossing>& crossings, EdgePiece& here, bool followed);
/// @param shape  a Circle
Side trace_circle(const Path& path, RegionId id, const scene::Shape& shape, const EdgePiece* contact,
                  std::vector<Crossing>& crossings);

/// A time as a quotient, with its error; recomputed in a hundred digits by `again` where the bound is poor.
template <class Again>
exact::Bounded quotient(const exact::Bounded& numerator, const exact::Bounded& denominator,
                        const Again& again) {
  const double t = numerator.value / denominator.value;
  const double error = (numerator.error + std::abs(t) * denominator.error) / std::abs(denominator.value) +
                       DBL_EPSILON * std::abs(t);
  if (denominator.has_sign() && error <= 32 * DBL_EPSILON * std::abs(t)) return {t, error};
  const double exact = static_cast<double>(again());
  return {exact, DBL_EPSILON * std::abs(exact)};
}

}  // namespace detail

}  // namespace hybrid_sphere
