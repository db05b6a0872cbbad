#include "own_ground.hpp"

#include <algorithm>
#include <cmath>

namespace hybrid_sphere::fuzz::own {
namespace {

Vec2 wide(const Vector2d& v) { return v.cast<Real>(); }

Edge line(const Vec2& a, const Vec2& normal) { return {a, normal.normalized(), 0}; }

void add_edges(const scene::Shape& shape, std::vector<Edge>& edges) {
  if (const auto* half_plane = std::get_if<scene::HalfPlane>(&shape)) {
    edges.push_back(line(wide(half_plane->point), wide(half_plane->normal)));
  } else if (const auto* circle = std::get_if<scene::Circle>(&shape)) {
    edges.push_back({wide(circle->center), Vec2::Zero(), circle->radius});
  } else {
    const auto& vertices = std::get<scene::Polygon>(shape).vertices;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const Vec2 a = wide(vertices[i]);
      const Vec2 side = wide(vertices[(i + 1) % vertices.size()]) - a;
      edges.push_back(line(a, Vec2(-side.y(), side.x())));
    }
  }
}

enum class Side { inside, edge, outside };

Side flipped(Side side, bool outside) {
  if (!outside || side == Side::edge) return side;
  return side == Side::inside ? Side::outside : Side::inside;
}

Side side_of(const scene::Polygon& polygon, const Vec2& r, Real slack) {
  bool within = false;
  for (std::size_t i = 0; i < polygon.vertices.size(); ++i) {
    const Vec2 a = wide(polygon.vertices[i]);
    const Vec2 b = wide(polygon.vertices[(i + 1) % polygon.vertices.size()]);
    const Vec2 side = b - a;
    const Real along = std::clamp(side.dot(r - a) / side.squaredNorm(), Real(0), Real(1));
    if ((a + along * side - r).norm() <= slack) return Side::edge;
    if ((a.y() > r.y()) == (b.y() > r.y())) continue;
    if (a.x() + (r.y() - a.y()) * side.x() / side.y() > r.x()) within = !within;
  }
  return flipped(within ? Side::inside : Side::outside, polygon.outside);
}

Side side_of(const scene::Shape& shape, const Vec2& r, Real slack) {
  const auto of = [slack](Real g) {
    return g > slack ? Side::inside : g < -slack ? Side::outside : Side::edge;
  };
  if (const auto* half_plane = std::get_if<scene::HalfPlane>(&shape))
    return of(line(wide(half_plane->point), wide(half_plane->normal)).at(r));
  if (const auto* circle = std::get_if<scene::Circle>(&shape))
    return flipped(of(circle->radius - (r - wide(circle->center)).norm()), circle->outside);
  return side_of(std::get<scene::Polygon>(shape), r, slack);
}

}  // namespace

std::vector<Edge> edges_of(const scene::Surface& surface) {
  std::vector<Edge> edges;
  for (const scene::Region& region : surface.regions) add_edges(region.shape, edges);
  return edges;
}

bool is_visible(const scene::Surface& surface, const Vec2& r, int region, Real slack, int& top) {
  top = base;
  bool found_top = false;
  bool visible = false;
  for (int i = static_cast<int>(surface.regions.size()) - 1; i >= 0; --i) {
    const Side side = side_of(surface.regions[static_cast<std::size_t>(i)].shape, r, slack);
    if (side == Side::outside) continue;
    if (!found_top) top = i;
    found_top = true;
    visible = visible || i == region;
    if (side == Side::inside) return visible;
  }
  return visible || region == base;
}

}  // namespace hybrid_sphere::fuzz::own
