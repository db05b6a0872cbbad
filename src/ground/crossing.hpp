#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/exact.hpp"
#include "hybrid_sphere/scene/scene.hpp"

namespace hybrid_sphere {

/// Index of a region in its surface; later regions lie on top of earlier ones.
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
    circle_first,   ///< a circle, where the path reaches it
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
  EdgePiece piece;          ///< what the path meets there
  std::int32_t along = -1;  ///< side of the polygon followed from there on, if `after` is Side::edge
  std::int8_t way = 0;      ///< 1 or -1: along or against the direction of a line that is traversed both ways
  double doubt = 0;         ///< bound on the error, if the crossings of one instant share their time
  bool joins = false;       ///< in that case: the previous crossing is at the same instant
};

/// The edge on which a path starts, known from the event that began it: exact even if the rounded position is
/// not.
struct Contact {
  RegionId region;
  EdgePiece piece;
  bool followed = false;  ///< the path runs along the piece, whatever rounding does to its direction
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

/// Inserts a contact after those with the edge of the same region.
inline void insert(const Contact& contact, Contacts& contacts) {
  contacts.insert(contacts_of(contacts, contact.region).second, contact);
}

/// Side of a point that does not move.
Side locate(const scene::Shape& shape, const Vector2d& point);

/// What the time of a crossing loses by rounding to binary64, to about as many further digits: for edges of
/// half-planes and sides of polygons, at the place where they are crossed; 0 for others.
double time_remainder(const Path& path, const scene::Shape& shape, const Crossing& crossing);

/// Order in time of two crossings of one path: -1, 0 or 1, decided exactly if the rounded times are too
/// close.
int compare(const Path& path, const scene::Shape& shape_a, const Crossing& a, const scene::Shape& shape_b,
            const Crossing& b);

/// Traces a path over a region: the side just after its start, and all changes of side after that.
/// No crossing is missed, however thin the region or shallow the angle: exact signs decide which edges are
/// crossed, and only the times are rounded.
/// @param contact    piece of this region's edge on which the path starts, or null when that is not known
/// beforehand
/// @param crossings  the changes are appended here, ascending in time
/// @param here       set to the piece of the edge that the path follows when the result is Side::edge
/// @param followed   the path lies on the contact's line, whatever rounding does to its direction
Side trace(const Path& path, RegionId id, const scene::Shape& shape, const EdgePiece* contact,
           std::vector<Crossing>& crossings, EdgePiece& here, bool followed = false);

/// Upper bound on the changes of side that trace can find.
std::size_t max_crossings(const scene::Shape& shape);

namespace detail {

/// @param shape  a Polygon
Side trace_polygon(const Path& path, RegionId id, const scene::Shape& shape, const EdgePiece* contact,
                   std::vector<Crossing>& crossings, EdgePiece& here, bool followed);
/// @param shape  a Circle
Side trace_circle(const Path& path, RegionId id, const scene::Shape& shape, const EdgePiece* contact,
                  std::vector<Crossing>& crossings);

/// A time as a quotient, with its error; `again` recomputes it in a hundred digits if the bound is poor.
template <class Again>
exact::Bounded quotient(const exact::Bounded& numerator, const exact::Bounded& denominator,
                        const Again& again) {
  const double t = numerator.value / denominator.value;
  const double error = (numerator.error + std::abs(t) * denominator.error) / std::abs(denominator.value) +
                       DBL_EPSILON * std::abs(t);
  if (denominator.has_sign() && error <= 32 * DBL_EPSILON * std::abs(t)) return {t, error};
  const double exact = again();
  return {exact, DBL_EPSILON * std::abs(exact)};
}

}  // namespace detail

}  // namespace hybrid_sphere
