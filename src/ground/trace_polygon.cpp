#include <algorithm>
#include <utility>

#include "ground/crossing.hpp"
#include "ground/exact_time.hpp"
#include "interrupt/interrupt.hpp"

namespace hybrid_sphere::detail {
namespace {

using exact::Bounded;
using exact::Difference;
using Kind = EdgePiece::Kind;

// What a crossing does to the side. It stands in Crossing::along until the sides themselves are known.
enum Change : std::int32_t { flip = -2, leave_edge_flipped = -3, leave_edge_same = -4 };

Side flipped(Side side) { return side == Side::inside ? Side::outside : Side::inside; }

/// Sign of cross(v, p - q), of which the value is known already.
int sign_exactly(const Bounded& value, const Vector2d& v, const Vector2d& p, const Vector2d& q) {
  return value.has_sign() ? exact::sign(value.value) : exact::sign_of_cross(v, p, q);
}

/// Walks round a polygon and notes where the path's line meets it. A side is crossed when its ends lie on
/// different sides of the line, so that the number of crossings is even whatever the rounding; corners on the
/// line are judged by the corners before and after them.
class PolygonTracer {
 public:
  PolygonTracer(const Path& path, RegionId id, const scene::Shape& shape, const EdgePiece* contact,
                std::vector<Crossing>& crossings, EdgePiece& here, bool followed)
      : path_(path),
        shape_(shape),
        vertices_(std::get<scene::Polygon>(shape).vertices),
        size_(static_cast<std::int32_t>(vertices_.size())),
        id_(id),
        contact_(contact && contact->kind == Kind::line ? contact->index : -1),
        reference_(path.start),
        crossings_(crossings),
        first_(crossings.size()),
        here_(here) {
    if (contact_ < 0) return;
    climb_ = followed ? 0 : exact::sign_of_cross(path.velocity, vertex(contact_ + 1), vertex(contact_));
    if (climb_ == 0) reference_ = vertex(contact_);
  }

  Side run() {
    note_all();
    const auto begin = crossings_.begin() + static_cast<std::ptrdiff_t>(first_);
    const auto earlier = [&](const Crossing& a, const Crossing& b) {
      interruption_point();
      return compare(path_, shape_, a, shape_, b) < 0;
    };
    if (crossings_.end() - begin > 2) {  // seldom
      std::sort(begin, crossings_.end(), earlier);
    } else if (crossings_.end() - begin == 2 && earlier(begin[1], begin[0])) {
      std::swap(begin[0], begin[1]);
    }
    return set_sides();
  }

 private:
  const Vector2d& vertex(std::int32_t i) const {
    return vertices_[static_cast<std::size_t>(i < size_ ? i : i - size_)];
  }
  std::int32_t previous(std::int32_t i) const { return i > 0 ? i - 1 : size_ - 1; }
  std::int32_t next(std::int32_t i) const { return i + 1 < size_ ? i + 1 : 0; }

  /// Side of the path's line on which a corner lies: 1 left, 0 on it, -1 right.
  int sign(std::int32_t i) const {
    if (contact_ >= 0) {  // the path starts between these two corners, or runs through them
      if (i == contact_) return -climb_;
      if (i == next(contact_)) return climb_;
    }
    return exact::sign_of_cross(path_.velocity, vertex(i), reference_);
  }

  void note_all() {
    std::int32_t start = 0;
    int first_sign = sign(0);
    while (first_sign == 0 && start + 1 < size_) first_sign = sign(++start);
    if (first_sign == 0) return;  // rounded to a line, a polygon has no corner off it
    int last = first_sign;
    std::int32_t on_line = -1;  // first of the corners on the line that were passed last
    for (std::int32_t i = next(start);; i = next(i)) {
      constexpr std::int32_t corners_a_turn = 64;
      if (i % corners_a_turn == 0) interruption_point();
      const int here = i == start ? first_sign : sign(i);
      if (here == 0) {
        if (on_line < 0) on_line = i;
      } else {
        if (on_line >= 0) {
          note_corners(on_line, previous(i), here != last);
          on_line = -1;
        } else if (here != last) {
          note_side(previous(i));
        }
        last = here;
      }
      if (i == start) return;
    }
  }

  void note_side(std::int32_t i) {
    if (i == contact_) return;
    Vector2d a = vertex(i);
    Vector2d b = vertex(i + 1);
    // One direction for both polygons that share a side: the same bits.
    if (std::make_pair(b.x(), b.y()) < std::make_pair(a.x(), a.y())) std::swap(a, b);
    const Difference side(b, a);
    const Bounded along = exact::cross(Difference(a, path_.start), side);
    const Bounded rate = exact::cross(Difference(path_.velocity), side);
    const int ahead = along.has_sign() ? exact::sign(along.value) : exact::orientation(path_.start, a, b);
    if (ahead * sign_exactly(rate, path_.velocity, b, a) <= 0) return;
    add({Kind::line, i}, along, rate, flip);
  }

  void note_corners(std::int32_t begin, std::int32_t end, bool flips) {
    if (begin == end) {
      if (flips) note_corner(begin, flip);
      return;
    }
    const bool ascending = exact::sign_of_dot(path_.velocity, vertex(end), vertex(begin)) > 0;
    if (!ascending) std::swap(begin, end);
    for (std::int32_t i = begin;; i = ascending ? next(i) : previous(i)) {
      if (i == end) {
        note_corner(i, flips ? leave_edge_flipped : leave_edge_same);
        return;
      }
      const std::int32_t following = ascending ? i : previous(i);
      if (note_corner(i, following)) continue;
      const std::int32_t corner = ascending ? next(i) : previous(i);
      if (ahead(corner)) {
        starts_on_edge_ = true;
        here_ = {Kind::line, following};
      }
    }
  }

  bool ahead(std::int32_t i) const { return exact::sign_of_dot(path_.velocity, vertex(i), path_.start) > 0; }

  bool note_corner(std::int32_t i, std::int32_t change) {
    if (!ahead(i)) return false;
    const Difference velocity(path_.velocity);
    add({Kind::vertex, i}, exact::dot(Difference(vertex(i), path_.start), velocity),
        exact::dot(velocity, velocity), change);
    return true;
  }

  void add(const EdgePiece& piece, const Bounded& numerator, const Bounded& denominator,
           std::int32_t change) {
    const Bounded time = quotient(numerator, denominator, [&] { return exact_time(path_, shape_, piece); });
    crossings_.push_back({time.value, time.error, id_, Side::edge, piece, change});
  }

  /// Far along the path is outside of any polygon: from there back to the start.
  Side set_sides() {
    Side side = std::get<scene::Polygon>(shape_).outside ? Side::inside : Side::outside;
    Side before_edge = side;
    for (std::size_t i = crossings_.size(); i-- > first_;) {
      Crossing& crossing = crossings_[i];
      const std::int32_t change = std::exchange(crossing.along, crossing.along >= 0 ? crossing.along : -1);
      if (change >= 0) {
        crossing.after = Side::edge;
        side = before_edge;
        continue;
      }
      crossing.after = side;
      if (change == flip) {
        side = flipped(side);
      } else {
        before_edge = change == leave_edge_flipped ? flipped(side) : side;
        side = Side::edge;
      }
    }
    return starts_on_edge_ ? Side::edge : side;
  }

  const Path& path_;
  const scene::Shape& shape_;
  const std::vector<Vector2d>& vertices_;
  std::int32_t size_;
  RegionId id_;
  std::int32_t contact_;  // side on which the path starts, or -1
  int climb_ = 0;         // side of the path's line on which that side ends; 0: the path follows it
  Vector2d reference_;    // a point of the path's line
  std::vector<Crossing>& crossings_;
  std::size_t first_;
  EdgePiece& here_;
  bool starts_on_edge_ = false;
};

}  // namespace

Side trace_polygon(const Path& path, RegionId id, const scene::Shape& shape, const EdgePiece* contact,
                   std::vector<Crossing>& crossings, EdgePiece& here, bool followed) {
  return PolygonTracer(path, id, shape, contact, crossings, here, followed).run();
}

}  // namespace hybrid_sphere::detail
