#include "hybrid_sphere/ros/triangulate.hpp"

#include "hybrid_sphere/geometry/exact.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

using Eigen::Vector2d;
using exact::orientation;

/// The box test spares most of the exact ones.
bool in_triangle(const Vector2d& p, const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const Vector2d low = a.cwiseMin(b).cwiseMin(c);
  const Vector2d high = a.cwiseMax(b).cwiseMax(c);
  if ((p.array() < low.array()).any() || (p.array() > high.array()).any()) return false;
  return orientation(a, b, p) >= 0 && orientation(b, c, p) >= 0 && orientation(c, a, p) >= 0;
}

/// Whether the triangle at a convex corner has no other corner in it. Corners at the place of one of its own
/// are those of a joined hole.
bool is_ear(const std::vector<Vector2d>& corners, const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  for (const Vector2d& p : corners) {
    if (p != a && p != b && p != c && in_triangle(p, a, b, c)) return false;
  }
  return true;
}

}  // namespace

std::vector<Vector2d> triangulate(std::vector<Vector2d> corners) {
  std::vector<Vector2d> triangles;
  std::size_t i = 0;
  std::size_t tried =
      0;  // corners in a row that could not be cut off: all of them only where the input is no polygon
  while (corners.size() >= 3 && tried < corners.size()) {
    const std::size_t n = corners.size();
    i %= n;
    const Vector2d a = corners[(i + n - 1) % n];
    const Vector2d b = corners[i];
    const Vector2d c = corners[(i + 1) % n];
    const int turn = orientation(a, b, c);
    if (turn < 0 || (turn > 0 && !is_ear(corners, a, b, c))) {
      ++i;
      ++tried;
      continue;
    }
    if (turn > 0) triangles.insert(triangles.end(), {a, b, c});
    corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(i));
    ++i;  // not twice at the same place: triangles become less thin
    tried = 0;
  }
  return triangles;
}

}  // namespace hybrid_sphere::ros_interface
