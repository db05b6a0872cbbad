#include "ground/exact_time.hpp"

#include "ground/hundred_digit_time.hpp"

namespace hybrid_sphere {
namespace {

using exact::Real;
using scene::Circle;
using scene::HalfPlane;
using scene::Polygon;

Real real_difference(double a, double b) { return Real(a) - Real(b); }

Real real_dot(const Vector2d& v, const Vector2d& p, const Vector2d& q) {
  return Real(v.x()) * real_difference(p.x(), q.x()) + Real(v.y()) * real_difference(p.y(), q.y());
}

Real time_on_polygon(const Path& path, const Polygon& polygon, const EdgePiece& piece) {
  const auto i = static_cast<std::size_t>(piece.index);
  const Vector2d& a = polygon.vertices[i];
  const Vector2d zero = Vector2d::Zero();
  if (piece.kind == EdgePiece::Kind::vertex) {
    return real_dot(path.velocity, a, path.start) / real_dot(path.velocity, path.velocity, zero);
  }
  const Vector2d& b = polygon.vertices[i + 1 < polygon.vertices.size() ? i + 1 : 0];
  const Real ex = real_difference(b.x(), a.x());
  const Real ey = real_difference(b.y(), a.y());
  const Real above =
      real_difference(a.x(), path.start.x()) * ey - real_difference(a.y(), path.start.y()) * ex;
  return above / (Real(path.velocity.x()) * ey - Real(path.velocity.y()) * ex);
}

/// A path and a circle, from the circle's centre.
struct PathNearCircle {
  PathNearCircle(const Path& path, const Circle& circle)
      : px(real_difference(path.start.x(), circle.center.x())),
        py(real_difference(path.start.y(), circle.center.y())),
        vx(path.velocity.x()),
        vy(path.velocity.y()),
        radius(circle.radius) {}

  Real across() const { return px * vy - py * vx; }
  Real speed_squared() const { return vx * vx + vy * vy; }

  Real px;
  Real py;
  Real vx;
  Real vy;
  Real radius;
};

Real time_on_circle(const Path& path, const Circle& circle, const EdgePiece& piece) {
  const PathNearCircle near(path, circle);
  const Real v2 = near.speed_squared();
  const Real pv = near.px * near.vx + near.py * near.vy;
  if (piece.kind == EdgePiece::Kind::circle_return) return Real(-2) * pv / v2;
  const Real across = near.across();
  const Real root = sqrt(Real(near.radius * near.radius * v2 - across * across));
  return (piece.kind == EdgePiece::Kind::circle_first ? Real(-pv - root) : Real(root - pv)) / v2;
}

}  // namespace

exact::Real hundred_digit_time(const Path& path, const scene::Shape& shape, const EdgePiece& piece) {
  if (const auto* circle = std::get_if<Circle>(&shape)) return time_on_circle(path, *circle, piece);
  if (const auto* polygon = std::get_if<Polygon>(&shape)) return time_on_polygon(path, *polygon, piece);
  const auto& half_plane = std::get<HalfPlane>(shape);
  return real_dot(half_plane.normal, half_plane.point, path.start) /
         real_dot(half_plane.normal, path.velocity, Vector2d::Zero());
}

double exact_time(const Path& path, const scene::Shape& shape, const EdgePiece& piece) {
  return static_cast<double>(hundred_digit_time(path, shape, piece));
}

int compare_exact_times(const Path& path, const scene::Shape& shape_a, const EdgePiece& piece_a,
                        const scene::Shape& shape_b, const EdgePiece& piece_b) {
  const Real time_a = hundred_digit_time(path, shape_a, piece_a);
  const Real time_b = hundred_digit_time(path, shape_b, piece_b);
  const Real gap = time_a - time_b;
  // Far above the rounding of a hundred digits, far below what data of 53 bits can tell apart.
  const Real indistinct = std::max(Real(abs(time_a)), Real(abs(time_b))) * Real(1e-75);
  return Real(abs(gap)) <= indistinct ? 0 : exact::sign(gap);
}

bool line_cuts_circle(const Path& path, const Circle& circle) {
  const PathNearCircle near(path, circle);
  const Real across = near.across();
  return near.radius * near.radius * near.speed_squared() > across * across;
}

}  // namespace hybrid_sphere
