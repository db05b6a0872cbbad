#include "ground/crossing.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ground/exact_time.hpp"

namespace hybrid_sphere {
namespace {

using scene::Circle;
using scene::HalfPlane;
using scene::Polygon;

template <class... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <class... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

Side side_of_sign(int sign) { return sign > 0 ? Side::inside : sign < 0 ? Side::outside : Side::edge; }

Side flipped(Side side) {
  return side == Side::edge ? side : side == Side::inside ? Side::outside : Side::inside;
}

Side trace_half_plane(const Path& path, RegionId id, const scene::Shape& shape, const EdgePiece* contact,
                      std::vector<Crossing>& crossings, EdgePiece& here, bool followed) {
  const auto& half_plane = std::get<HalfPlane>(shape);
  here = {EdgePiece::Kind::line, 0};
  if (followed) return Side::edge;
  const int height = contact ? 0 : exact::sign_of_dot(half_plane.normal, path.start, half_plane.point);
  const int climb = exact::sign_of_dot(half_plane.normal, path.velocity, Vector2d::Zero());
  if (climb == 0) return side_of_sign(height);
  if (height == 0 || height == climb) return side_of_sign(climb);
  const exact::Difference normal(half_plane.normal);
  const exact::Bounded time = detail::quotient(
      exact::dot(normal, exact::Difference(half_plane.point, path.start)),
      exact::dot(normal, exact::Difference(path.velocity)), [&] { return exact_time(path, shape, here); });
  crossings.push_back({time.value, time.error, id, side_of_sign(climb), here, -1});
  return side_of_sign(height);
}

// Left of a, right of b, or on a side: the parity of the sides that lie to the right of the point.
Side locate_in_polygon(const Polygon& polygon, const Vector2d& point) {
  const std::size_t n = polygon.vertices.size();
  bool inside = false;
  for (std::size_t i = 0; i < n; ++i) {
    const Vector2d& a = polygon.vertices[i];
    const Vector2d& b = polygon.vertices[i + 1 < n ? i + 1 : 0];
    const auto [x_low, x_high] = std::minmax(a.x(), b.x());
    const auto [y_low, y_high] = std::minmax(a.y(), b.y());
    if (!(y_low <= point.y() && point.y() <= y_high && point.x() <= x_high)) continue;
    const bool spans = (a.y() > point.y()) != (b.y() > point.y());
    bool lies_right = point.x() < x_low;
    if (!lies_right) {
      const int turn = exact::orientation(a, b, point);
      if (turn == 0) return Side::edge;
      lies_right = (turn > 0) == (b.y() > a.y());
    }
    if (spans && lies_right) inside = !inside;
  }
  return inside != polygon.outside ? Side::inside : Side::outside;
}

const Vector2d& vertex_of(const Polygon& polygon, std::int32_t i) {
  const auto k = static_cast<std::size_t>(i);
  return polygon.vertices[k < polygon.vertices.size() ? k : 0];
}

bool same_side(const Polygon& p, const EdgePiece& a, const Polygon& q, const EdgePiece& b) {
  const Vector2d& a0 = vertex_of(p, a.index);
  const Vector2d& b0 = vertex_of(q, b.index);
  if (a.kind == EdgePiece::Kind::vertex) return a0 == b0;
  const Vector2d& a1 = vertex_of(p, a.index + 1);
  const Vector2d& b1 = vertex_of(q, b.index + 1);
  return (a0 == b0 && a1 == b1) || (a0 == b1 && a1 == b0);
}

/// Whether two pieces are the same numbers, so that no arithmetic is needed to see that they are met at one
/// instant.
bool same_piece(const scene::Shape& shape_a, const EdgePiece& a, const scene::Shape& shape_b,
                const EdgePiece& b) {
  if (a.kind != b.kind || shape_a.index() != shape_b.index()) return false;
  return std::visit(
      Overloaded{[&](const HalfPlane& p) {
                   const auto& q = std::get<HalfPlane>(shape_b);
                   return p.point == q.point && (p.normal == q.normal || p.normal == -q.normal);
                 },
                 [&](const Circle& p) {
                   const auto& q = std::get<Circle>(shape_b);
                   return p.center == q.center && p.radius == q.radius;
                 },
                 [&](const Polygon& p) { return same_side(p, a, std::get<Polygon>(shape_b), b); }},
      shape_a);
}

/// Whether two sides of polygons lie on one line, which the path then meets at one instant.
bool on_one_line(const scene::Shape& shape_a, const EdgePiece& a, const scene::Shape& shape_b,
                 const EdgePiece& b) {
  const auto* p = std::get_if<Polygon>(&shape_a);
  const auto* q = std::get_if<Polygon>(&shape_b);
  if (!p || !q || a.kind != EdgePiece::Kind::line || b.kind != EdgePiece::Kind::line) return false;
  const auto is_on_line = [&](const Vector2d& point) {
    return exact::orientation(vertex_of(*p, a.index), vertex_of(*p, a.index + 1), point) == 0;
  };
  return is_on_line(vertex_of(*q, b.index)) && is_on_line(vertex_of(*q, b.index + 1));
}

/// Adds a b to an unevaluated sum.
void add_product(double a, double b, exact::DoubleDouble& sum) {
  const exact::DoubleDouble product = exact::two_product(a, b);
  const exact::DoubleDouble value = exact::two_sum(sum.value, product.value);
  sum = {value.value, (sum.remainder + product.remainder) + value.remainder};
}

// n.(p - r(time)) over n.v, n = value + remainder.
double remainder_on_line(const Path& path, const exact::Difference& normal, const Vector2d& point,
                         double time) {
  const exact::Difference way(point, path.start);
  exact::DoubleDouble height;
  for (int i = 0; i < 2; ++i) {
    const exact::DoubleDouble moved = exact::two_product(time, path.velocity[i]);
    add_product(normal.value[i], way.value[i], height);
    add_product(-normal.value[i], moved.value, height);
    height.remainder += normal.value[i] * (way.remainder[i] - moved.remainder);
    height.remainder += normal.remainder[i] * (way.value[i] - moved.value);
  }
  return (height.value + height.remainder) / (normal.value + normal.remainder).dot(path.velocity);
}

}  // namespace

double time_remainder(const Path& path, const scene::Shape& shape, const Crossing& crossing) {
  if (crossing.piece.kind != EdgePiece::Kind::line) return 0;
  double remainder = 0;
  if (const auto* half_plane = std::get_if<HalfPlane>(&shape)) {
    remainder =
        remainder_on_line(path, exact::Difference(half_plane->normal), half_plane->point, crossing.time);
  } else if (const auto* polygon = std::get_if<Polygon>(&shape)) {
    const auto i = static_cast<std::size_t>(crossing.piece.index);
    const Vector2d& a = polygon->vertices[i];
    const Vector2d& b = polygon->vertices[i + 1 < polygon->vertices.size() ? i + 1 : 0];
    remainder = remainder_on_line(path, exact::Difference(b, a).turned(), a, crossing.time);
  }
  // Numbers that underflow tell nothing.
  return std::abs(remainder) <= crossing.error ? remainder : 0;
}

Side locate(const scene::Shape& shape, const Vector2d& point) {
  return std::visit(
      Overloaded{
          [&](const HalfPlane& s) { return side_of_sign(exact::sign_of_dot(s.normal, point, s.point)); },
          [&](const Circle& s) {
            const Side side = side_of_sign(-exact::side_of_circle(point, s.center, s.radius));
            return s.outside ? flipped(side) : side;
          },
          [&](const Polygon& s) { return locate_in_polygon(s, point); }},
      shape);
}

int compare(const Path& path, const scene::Shape& shape_a, const Crossing& a, const scene::Shape& shape_b,
            const Crossing& b) {
  const double gap = a.time - b.time;
  if (std::abs(gap) > a.error + b.error) return exact::sign(gap);
  if (same_piece(shape_a, a.piece, shape_b, b.piece) || on_one_line(shape_a, a.piece, shape_b, b.piece))
    return 0;
  return compare_exact_times(path, shape_a, a.piece, shape_b, b.piece);
}

Side trace(const Path& path, RegionId id, const scene::Shape& shape, const EdgePiece* contact,
           std::vector<Crossing>& crossings, EdgePiece& here, bool followed) {
  if (!path.moves()) {
    here = contact ? *contact : EdgePiece{EdgePiece::Kind::vertex, 0};  // no side is followed
    return contact ? Side::edge : locate(shape, path.start);
  }
  return std::visit(
      Overloaded{[&](const HalfPlane&) {
                   return trace_half_plane(path, id, shape, contact, crossings, here, followed);
                 },
                 [&](const Circle&) { return detail::trace_circle(path, id, shape, contact, crossings); },
                 [&](const Polygon&) {
                   return detail::trace_polygon(path, id, shape, contact, crossings, here, followed);
                 }},
      shape);
}

std::size_t max_crossings(const scene::Shape& shape) {
  return std::visit(Overloaded{[](const HalfPlane&) { return std::size_t{1}; },
                               [](const Circle&) { return std::size_t{2}; },
                               [](const Polygon& s) { return s.vertices.size(); }},
                    shape);
}

}  // namespace hybrid_sphere
