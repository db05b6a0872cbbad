#include "support/place.hpp"

#include <algorithm>
#include <cmath>

namespace hybrid_sphere::testing {
namespace {

using Real = long double;

// Edges of the polygon that a ray from the point to the right crosses: an odd number from within.
bool is_within(const std::vector<Vector2d>& corners, const Vector2d& point) {
  const Real x = point.x();
  const Real y = point.y();
  bool within = false;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector2d& p = corners[i];
    const Vector2d& q = corners[(i + 1) % corners.size()];
    if ((p.y() > y) == (q.y() > y)) continue;
    const Real px = p.x();
    const Real py = p.y();
    const Real at = px + (y - py) * (q.x() - px) / (q.y() - py);
    if (at > x) within = !within;
  }
  return within;
}

double distance_to_segment(const Vector2d& a, const Vector2d& b, const Vector2d& point) {
  const double along = std::clamp((point - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (point - a - along * (b - a)).norm();
}

}  // namespace

bool holds(const scene::Shape& shape, const Vector2d& point) {
  const Real x = point.x();
  const Real y = point.y();
  if (const auto* half_plane = std::get_if<scene::HalfPlane>(&shape)) {
    const Vector2d& n = half_plane->normal;
    return n.x() * (x - half_plane->point.x()) + n.y() * (y - half_plane->point.y()) >= 0;
  }
  if (const auto* circle = std::get_if<scene::Circle>(&shape)) {
    return (std::hypot(x - circle->center.x(), y - circle->center.y()) <= circle->radius) != circle->outside;
  }
  const auto& polygon = std::get<scene::Polygon>(shape);
  return is_within(polygon.vertices, point) != polygon.outside;
}

int region_at(const scene::Surface& surface, const Vector2d& point) {
  int region = static_cast<int>(surface.regions.size()) - 1;
  while (region >= 0 && !holds(surface.regions[static_cast<std::size_t>(region)].shape, point)) --region;
  return region;
}

double distance_to_edge(const scene::Shape& shape, const Vector2d& point) {
  if (const auto* half_plane = std::get_if<scene::HalfPlane>(&shape)) {
    return std::abs(half_plane->normal.normalized().dot(point - half_plane->point));
  }
  if (const auto* circle = std::get_if<scene::Circle>(&shape)) {
    return std::abs((point - circle->center).norm() - circle->radius);
  }
  const std::vector<Vector2d>& corners = std::get<scene::Polygon>(shape).vertices;
  double distance = HUGE_VAL;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    distance = std::min(distance, distance_to_segment(corners[i], corners[(i + 1) % corners.size()], point));
  }
  return distance;
}

double distance_to_edge(const scene::Surface& surface, const Vector2d& point) {
  double distance = HUGE_VAL;
  for (const scene::Region& region : surface.regions)
    distance = std::min(distance, distance_to_edge(region.shape, point));
  return distance;
}

}  // namespace hybrid_sphere::testing
