#include "ros/markers/surface_outline.hpp"

#include <algorithm>
#include <cmath>

#include "ros/markers/triangulate.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

using Points = std::vector<Vector2d>;

/// Grows around points.
struct PointExtent {
  Vector2d low;
  Vector2d high;

  void add(const Vector2d& point, double around = 0) {
    low = low.cwiseMin(point - Vector2d::Constant(around));
    high = high.cwiseMax(point + Vector2d::Constant(around));
  }
  void operator()(const scene::HalfPlane& half_plane) { add(half_plane.point); }
  void operator()(const scene::Circle& circle) { add(circle.center, circle.radius); }
  void operator()(const scene::Polygon& polygon) {
    for (const Vector2d& vertex : polygon.vertices) add(vertex);
  }
};

Points closed_edges(const Points& corners) {
  Points edges;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    edges.push_back(corners[i]);
    edges.push_back(corners[(i + 1) % corners.size()]);
  }
  return edges;
}

Points fan(const Points& convex) {
  Points triangles;
  for (std::size_t i = 2; i < convex.size(); ++i) {
    triangles.insert(triangles.end(), {convex[0], convex[i - 1], convex[i]});
  }
  return triangles;
}

Outline draw(const scene::HalfPlane& half_plane, const ViewSquare& view, const Detail&) {
  const Vector2d n = half_plane.normal.stableNormalized();
  const auto depth = [&](const Vector2d& p) { return n.dot(p - half_plane.point); };
  const Points square = view.corners();
  Points inside;
  Outline outline;
  for (std::size_t i = 0; i < square.size(); ++i) {
    const Vector2d& a = square[i];
    const Vector2d& b = square[(i + 1) % square.size()];
    if (depth(a) >= 0) inside.push_back(a);
    if ((depth(a) >= 0) != (depth(b) >= 0)) {
      const Vector2d crossing = a + depth(a) / (depth(a) - depth(b)) * (b - a);
      inside.push_back(crossing);
      outline.edges.push_back(crossing);
    }
  }
  outline.triangles = fan(inside);
  return outline;
}

Vector2d direction(double angle) { return {std::cos(angle), std::sin(angle)}; }

/// Where a ray from a point inside the square leaves it.
Vector2d at_square(const ViewSquare& view, const Vector2d& from, const Vector2d& along) {
  double length = HUGE_VAL;
  for (int axis : {0, 1}) {
    if (along[axis] == 0) continue;
    const double side = view.center[axis] + std::copysign(view.half, along[axis]);
    length = std::min(length, (side - from[axis]) / along[axis]);
  }
  return from + length * along;
}

/// The square without a disc: quadrangles between rays from the centre, of which four go to the corners.
Points around_circle(const scene::Circle& circle, const ViewSquare& view, int circle_sides) {
  std::vector<double> angles;
  for (int i = 0; i < circle_sides; ++i) angles.push_back(2 * M_PI * i / circle_sides - M_PI);
  for (const Vector2d& corner : view.corners()) {
    const Vector2d ray = corner - circle.center;
    angles.push_back(std::atan2(ray.y(), ray.x()));
  }
  std::sort(angles.begin(), angles.end());
  angles.push_back(angles.front() + 2 * M_PI);
  Points triangles;
  for (std::size_t i = 1; i < angles.size(); ++i) {
    const Vector2d from = direction(angles[i - 1]);
    const Vector2d to = direction(angles[i]);
    const Vector2d inner_from = circle.center + circle.radius * from;
    const Vector2d inner_to = circle.center + circle.radius * to;
    const Vector2d outer_to = at_square(view, circle.center, to);
    triangles.insert(triangles.end(), {inner_from, at_square(view, circle.center, from), outer_to});
    triangles.insert(triangles.end(), {inner_from, outer_to, inner_to});
  }
  return triangles;
}

Outline draw(const scene::Circle& circle, const ViewSquare& view, const Detail& detail) {
  const int circle_sides = detail.circle_sides;
  Points rim;
  for (int i = 0; i < circle_sides; ++i) {
    rim.emplace_back(circle.center + circle.radius * direction(2 * M_PI * i / circle_sides));
  }
  return {circle.outside ? around_circle(circle, view, circle_sides) : fan(rim), closed_edges(rim)};
}

Outline draw(const scene::Polygon& polygon, const ViewSquare& view, const Detail& detail) {
  Outline outline;
  outline.edges = closed_edges(polygon.vertices);
  if (!detail.fills) return outline;
  if (polygon.outside) {
    outline.triangles =
        triangulate({view.corners(), Points(polygon.vertices.rbegin(), polygon.vertices.rend())});
  } else {
    outline.triangles = triangulate({polygon.vertices});
  }
  return outline;
}

}  // namespace

std::vector<Vector2d> ViewSquare::corners() const {
  return {center + Vector2d(-half, -half), center + Vector2d(half, -half), center + Vector2d(half, half),
          center + Vector2d(-half, half)};
}

ViewSquare view_around(const scene::Surface& surface, const std::vector<Vector2d>& positions, double radius) {
  PointExtent box{positions.front(), positions.front()};
  for (const Vector2d& position : positions) box.add(position, radius);
  for (const scene::Region& region : surface.regions) std::visit(box, region.shape);
  const double extent = (box.high - box.low).maxCoeff();
  return {0.5 * (box.low + box.high), extent + 10 * radius};
}

Eigen::AlignedBox3d bounded_extent(const scene::Shape& shape) {
  Eigen::AlignedBox3d extent;
  if (std::holds_alternative<scene::HalfPlane>(shape)) return extent;
  PointExtent box{Vector2d::Constant(HUGE_VAL), Vector2d::Constant(-HUGE_VAL)};
  std::visit(box, shape);
  extent.min() << box.low, 0;
  extent.max() << box.high, 0;
  return extent;
}

Eigen::AlignedBox3d bounded_extent(const scene::Surface& surface) {
  Eigen::AlignedBox3d extent;
  for (const scene::Region& region : surface.regions) extent.extend(bounded_extent(region.shape));
  return extent;
}

Outline outline_of(const scene::Shape& shape, const ViewSquare& view, const Detail& detail) {
  return std::visit([&](const auto& each) { return draw(each, view, detail); }, shape);
}

}  // namespace hybrid_sphere::ros_interface
