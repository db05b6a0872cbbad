#include "hybrid_sphere/geometry/simple_polygon.hpp"

#include <algorithm>
#include <numeric>

#include "hybrid_sphere/geometry/exact.hpp"

namespace hybrid_sphere::geometry {
namespace {

using Eigen::Vector2d;
using exact::orientation;

struct Side {
  Vector2d a;
  Vector2d b;
  double low_x() const { return std::min(a.x(), b.x()); }
  double high_x() const { return std::max(a.x(), b.x()); }
  double low_y() const { return std::min(a.y(), b.y()); }
  double high_y() const { return std::max(a.y(), b.y()); }
};

bool boxes_meet(const Side& p, const Side& q) {
  return p.low_x() <= q.high_x() && q.low_x() <= p.high_x() && p.low_y() <= q.high_y() &&
         q.low_y() <= p.high_y();
}

bool meet(const Side& p, const Side& q) {
  return boxes_meet(p, q) && orientation(p.a, p.b, q.a) * orientation(p.a, p.b, q.b) <= 0 &&
         orientation(q.a, q.b, p.a) * orientation(q.a, q.b, p.b) <= 0;
}

std::string number(std::size_t i) { return std::to_string(i); }

// Sides by their left ends: only those that overlap in x are compared.
std::optional<std::string> fault_of_pairs(const std::vector<Side>& sides) {
  const std::size_t n = sides.size();
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return sides[i].low_x() < sides[j].low_x(); });
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t i = order[k];
    for (std::size_t l = k + 1; l < n && sides[order[l]].low_x() <= sides[i].high_x(); ++l) {
      const std::size_t j = order[l];
      const bool neighbours = (i + 1) % n == j || (j + 1) % n == i;
      if (!neighbours && meet(sides[i], sides[j])) {
        return "sides " + number(std::min(i, j)) + " and " + number(std::max(i, j)) + " meet";
      }
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> fault_of_polygon(const std::vector<Vector2d>& vertices) {
  const std::size_t n = vertices.size();
  if (n < 3) return number(n) + " corners";
  std::vector<Side> sides;
  sides.reserve(n);
  for (std::size_t i = 0; i < n; ++i) sides.push_back({vertices[i], vertices[(i + 1) % n]});
  for (std::size_t i = 0; i < n; ++i) {
    const Side& side = sides[i];
    const Vector2d& after = sides[(i + 1) % n].b;
    if (side.a == side.b) return "corners " + number(i) + " and " + number((i + 1) % n) + " are equal";
    if (orientation(side.a, side.b, after) == 0 && (side.b - side.a).dot(after - side.b) < 0) {
      return "the sides at corner " + number((i + 1) % n) + " lie over each other";
    }
  }
  return fault_of_pairs(sides);
}

bool is_counter_clockwise(const std::vector<Vector2d>& vertices) {
  const std::size_t n = vertices.size();
  const auto before = [](const Vector2d& a, const Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  };
  const auto i =
      static_cast<std::size_t>(std::min_element(vertices.begin(), vertices.end(), before) - vertices.begin());
  return orientation(vertices[(i + n - 1) % n], vertices[i], vertices[(i + 1) % n]) > 0;
}

}  // namespace hybrid_sphere::geometry
