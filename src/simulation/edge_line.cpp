#include "simulation/edge_line.hpp"

#include <algorithm>
#include <cmath>

#include "motion/motion.hpp"

namespace hybrid_sphere {

using scene::Circle;
using scene::HalfPlane;
using scene::Polygon;

double size_of(const scene::Shape& shape) {
  if (const auto* half_plane = std::get_if<HalfPlane>(&shape)) return half_plane->point.norm();
  if (const auto* circle = std::get_if<Circle>(&shape)) return circle->center.norm() + 2 * circle->radius;
  double size = 0;
  for (const Vector2d& vertex : std::get<Polygon>(shape).vertices) size = std::max(size, vertex.norm());
  return size;
}

std::optional<EdgeLine> line_of(const scene::Shape& shape, const EdgePiece& piece) {
  if (piece.kind != EdgePiece::Kind::line) return std::nullopt;
  if (const auto* half_plane = std::get_if<HalfPlane>(&shape)) {
    return EdgeLine{half_plane->point, turned(half_plane->normal)};
  }
  const auto* polygon = std::get_if<Polygon>(&shape);
  if (!polygon) return std::nullopt;
  const auto k = static_cast<std::size_t>(piece.index);
  const auto& vertices = polygon->vertices;
  return EdgeLine{vertices[k], vertices[k + 1 < vertices.size() ? k + 1 : 0] - vertices[k]};
}

bool are_parallel(const EdgeLine& a, const EdgeLine& b) {
  return std::abs(a.direction.dot(turned(b.direction))) <= 0x1p-40 * a.direction.norm() * b.direction.norm();
}

std::optional<LocalEdge> local_edge(const scene::Shape& shape, const EdgePiece& piece,
                                    const Vector2d& position) {
  if (const auto* circle = std::get_if<Circle>(&shape)) {
    const double inwards = circle->outside ? 1 : -1;
    return LocalEdge{inwards * (position - circle->center).normalized(), inwards / circle->radius};
  }
  const std::optional<EdgeLine> line = line_of(shape, piece);
  if (!line) return std::nullopt;
  if (const auto* half_plane = std::get_if<HalfPlane>(&shape)) {
    return LocalEdge{half_plane->normal.normalized()};
  }
  const double inwards = std::get<Polygon>(shape).outside ? -1 : 1;
  return LocalEdge{inwards * turned(line->direction).normalized()};
}

Vector2d put_on_edge(const scene::Shape& shape, const EdgePiece& piece, const Vector2d& position) {
  if (const auto* circle = std::get_if<Circle>(&shape)) {
    return circle->center + circle->radius * (position - circle->center).normalized();
  }
  const std::optional<EdgeLine> line = line_of(shape, piece);
  const Vector2d normal = turned(line->direction).normalized();
  Vector2d foot = position - normal.dot(position - line->point) * normal;
  if (line->direction.x() == 0) foot.x() = line->point.x();
  if (line->direction.y() == 0) foot.y() = line->point.y();
  return foot;
}

namespace {

std::optional<Touch> touch_of(const EdgeLine& line, const Circle& circle, double rounding) {
  const Vector2d normal = turned(line.direction).normalized();
  const double height = normal.dot(circle.center - line.point);
  if (std::abs(std::abs(height) - circle.radius) > rounding) return std::nullopt;
  return Touch{circle.center - height * normal, circle.radius};
}

std::optional<Touch> touch_of(const Circle& a, const Circle& b, double rounding) {
  const Circle& small = a.radius <= b.radius ? a : b;
  const Circle& large = a.radius <= b.radius ? b : a;
  const Vector2d between = small.center - large.center;
  const double distance = between.norm();
  const bool inside = std::abs(distance - (large.radius - small.radius)) <= rounding;
  const bool beside = std::abs(distance - (large.radius + small.radius)) <= rounding;
  if (distance <= rounding || !(inside || beside)) return std::nullopt;
  return Touch{large.center + large.radius / distance * between, small.radius};
}

}  // namespace

std::optional<Touch> touch_of(const scene::Shape& a, const EdgePiece& piece_a, const scene::Shape& b,
                              const EdgePiece& piece_b, double rounding) {
  const auto* circle_a = std::get_if<Circle>(&a);
  const auto* circle_b = std::get_if<Circle>(&b);
  if (circle_a && circle_b) return touch_of(*circle_a, *circle_b, rounding);
  const std::optional<EdgeLine> line = circle_a ? line_of(b, piece_b) : line_of(a, piece_a);
  if (!line || (!circle_a && !circle_b)) return std::nullopt;
  return touch_of(*line, circle_a ? *circle_a : *circle_b, rounding);
}

double distance_to_side(const Polygon& polygon, std::int32_t side, const Vector2d& position) {
  const auto index = static_cast<std::size_t>(side);
  const Vector2d& from = polygon.vertices[index];
  const Vector2d along = polygon.vertices[index + 1 < polygon.vertices.size() ? index + 1 : 0] - from;
  const double share = std::clamp((position - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (position - from - share * along).norm();
}

bool holds(const scene::Shape& shape, const EdgePiece& piece, const Vector2d& point, double rounding) {
  const std::optional<EdgeLine> line = line_of(shape, piece);
  if (!line) return false;
  if (std::holds_alternative<HalfPlane>(shape)) return true;
  const double length = line->direction.norm();  // of a polygon's side
  const double along = line->direction.dot(point - line->point) / length;
  return -rounding <= along && along <= length + rounding;
}

std::optional<Vector2d> corner_of(const scene::Shape& a, const EdgePiece& piece_a, const scene::Shape& b,
                                  const EdgePiece& piece_b, double rounding) {
  const std::optional<EdgeLine> first = line_of(a, piece_a);
  const std::optional<EdgeLine> second = line_of(b, piece_b);
  if (!first || !second) return std::nullopt;
  const double between = second->direction.dot(turned(first->direction));
  if (between == 0) return std::nullopt;
  const double share = turned(second->direction).dot(second->point - first->point) / -between;
  const Vector2d meeting = first->point + share * first->direction;
  for (const scene::Shape* shape : {&a, &b}) {
    if (const auto* half_plane = std::get_if<HalfPlane>(shape)) {
      if ((half_plane->point - meeting).norm() <= rounding) return half_plane->point;
    } else if (const auto* polygon = std::get_if<Polygon>(shape)) {
      for (const Vector2d& vertex : polygon->vertices) {
        if ((vertex - meeting).norm() <= rounding) return vertex;
      }
    }
  }
  return meeting;
}

}  // namespace hybrid_sphere
