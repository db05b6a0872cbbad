#include "html/rings.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace hybrid_sphere::html {
namespace {

constexpr double margin = 0.05;  // between what is left out of a region and the end of the drawing

/// The part of a ring where `depth`, which is linear, is not negative. Source: Sutherland and Hodgman.
Ring clipped(const Ring& ring, const std::function<double(const Vector2d&)>& depth) {
  Ring result;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vector2d& a = ring[i];
    const Vector2d& b = ring[(i + 1) % ring.size()];
    const double at_a = depth(a);
    const double at_b = depth(b);
    if (at_a >= 0) result.push_back(a);
    if ((at_a >= 0) != (at_b >= 0)) result.emplace_back(a + at_a / (at_a - at_b) * (b - a));
  }
  return result;
}

Ring clipped(Ring ring, const Rectangle& box) {
  for (const int axis : {0, 1}) {
    ring = clipped(ring, [&](const Vector2d& p) { return p[axis] - box.low[axis]; });
    ring = clipped(ring, [&](const Vector2d& p) { return box.high[axis] - p[axis]; });
  }
  return ring.size() < 3 ? Ring() : ring;
}

/// Without corners that are nearer to the one before than the tolerance.
Ring thinned(const Ring& ring, double tolerance) {
  Ring result;
  for (const Vector2d& corner : ring) {
    if (result.empty() || (corner - result.back()).norm() > tolerance) result.push_back(corner);
  }
  return result.size() < 3 ? ring : result;
}

double size_of(const Rectangle& box) { return (box.high - box.low).norm(); }

/// Of a whole circle; a chord is as far from it as the tolerance.
int sides_of(double radius, double tolerance) {
  return static_cast<int>(std::clamp(M_PI * std::sqrt(radius / (2 * tolerance)), 32.0, 256.0));
}

/// A disc; of one that is much larger than the drawing what lies near it.
Ring disc(const scene::Circle& circle, const Drawing& drawing) {
  const double size = size_of(drawing.inside);
  const Vector2d middle = 0.5 * (drawing.inside.low + drawing.inside.high);
  const Vector2d center = circle.center - drawing.origin;
  const double distance = (middle - center).norm();
  if (distance - circle.radius > size) return {};
  if (circle.radius - distance > size) return drawing.inside.corners();
  const bool whole = circle.radius <= 2 * size;
  const double reach = whole ? M_PI : 2 * size / circle.radius;
  const int sides = whole ? sides_of(circle.radius, drawing.tolerance) : 256;
  const double toward = std::atan2(middle.y() - center.y(), middle.x() - center.x());
  Ring ring;
  for (int i = 0; i < sides; ++i) {
    const double angle = toward + reach * (2.0 * i / (whole ? sides : sides - 1) - 1);
    ring.emplace_back(center + circle.radius * Vector2d(std::cos(angle), std::sin(angle)));
  }
  if (!whole) {
    const Vector2d inwards = -4 * size * Vector2d(std::cos(toward), std::sin(toward));
    ring.emplace_back(ring.back() + inwards);
    ring.emplace_back(ring.front() + inwards);
  }
  return ring;
}

Ring outline(const scene::Polygon& polygon, const Drawing& drawing) {
  Ring ring;
  ring.reserve(polygon.vertices.size());
  for (const Vector2d& vertex : polygon.vertices) ring.emplace_back(vertex - drawing.origin);
  return thinned(ring, drawing.tolerance);
}

double area(const Ring& ring) {
  double twice = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vector2d& a = ring[i];
    const Vector2d& b = ring[(i + 1) % ring.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

std::vector<Ring> rings(const Ring& ring, bool outside, const Drawing& drawing) {
  if (!outside) {
    Ring inside = clipped(ring, drawing.inside);
    return inside.empty() ? std::vector<Ring>() : std::vector<Ring>{std::move(inside)};
  }
  // A hole that does not meet the outline.
  const Rectangle within = drawing.inside.grown(-margin * size_of(drawing.inside));
  Ring hole = clipped(ring, within);
  if (hole.empty()) return {drawing.inside.corners()};
  if (area(hole) >= area(within.corners()) * (1 - 1e-12)) return {};
  std::reverse(hole.begin(), hole.end());
  return {drawing.inside.corners(), std::move(hole)};
}

std::vector<Ring> draw(const scene::HalfPlane& half_plane, const Drawing& drawing) {
  const Vector2d normal = half_plane.normal.stableNormalized();
  const Vector2d point = half_plane.point - drawing.origin;
  Ring ring = clipped(drawing.inside.corners(), [&](const Vector2d& p) { return normal.dot(p - point); });
  return ring.size() < 3 ? std::vector<Ring>() : std::vector<Ring>{std::move(ring)};
}
std::vector<Ring> draw(const scene::Circle& circle, const Drawing& drawing) {
  return rings(disc(circle, drawing), circle.outside, drawing);
}
std::vector<Ring> draw(const scene::Polygon& polygon, const Drawing& drawing) {
  return rings(outline(polygon, drawing), polygon.outside, drawing);
}

}  // namespace

Ring Rectangle::corners() const { return {low, {high.x(), low.y()}, high, {low.x(), high.y()}}; }

std::vector<Ring> rings_of(const scene::Shape& shape, const Drawing& drawing) {
  return std::visit([&](const auto& each) { return draw(each, drawing); }, shape);
}

std::size_t corners_of(const scene::Shape& shape, const Drawing& drawing) {
  if (const auto* polygon = std::get_if<scene::Polygon>(&shape)) return polygon->vertices.size() + 4;
  const auto* circle = std::get_if<scene::Circle>(&shape);
  return circle != nullptr ? static_cast<std::size_t>(sides_of(circle->radius, drawing.tolerance)) + 4 : 5;
}

Rectangle box_of(const scene::Shape& shape) {
  if (const auto* circle = std::get_if<scene::Circle>(&shape)) {
    return Rectangle{circle->center, circle->center}.grown(circle->radius);
  }
  if (const auto* polygon = std::get_if<scene::Polygon>(&shape)) {
    Rectangle box{polygon->vertices.front(), polygon->vertices.front()};
    for (const Vector2d& vertex : polygon->vertices) {
      box = {box.low.cwiseMin(vertex), box.high.cwiseMax(vertex)};
    }
    return box;
  }
  return {Vector2d::Constant(-HUGE_VAL), Vector2d::Constant(HUGE_VAL)};
}

}  // namespace hybrid_sphere::html
