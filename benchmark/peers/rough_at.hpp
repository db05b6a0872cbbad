#pragma once

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "hybrid_sphere/scene/scene.hpp"

namespace hybrid_sphere::peers {

/// Whether the ground at a point allows no slip, in plain binary64 arithmetic and a few nanoseconds: what the
/// others are given at every step. hybrid_sphere's own query decides edges exactly, which takes longer than a
/// step of theirs.
class RoughAt {
 public:
  /// @throws std::invalid_argument  for shapes other than half-planes and convex polygons
  explicit RoughAt(const scene::Surface& surface) : base_(surface.base.law == scene::Law::rough) {
    for (const scene::Region& region : surface.regions) {
      regions_.push_back({lines(region.shape), region.material.law == scene::Law::rough});
    }
    std::reverse(regions_.begin(), regions_.end());  // the uppermost first
  }

  bool operator()(const Vector2d& r) const {
    for (const Region& region : regions_) {
      if (region.holds(r)) return region.rough;
    }
    return base_;
  }

 private:
  struct Line {
    Vector2d normal;  ///< into the region
    double offset;
  };
  struct Region {
    std::vector<Line> lines;
    bool rough;
    bool holds(const Vector2d& r) const {
      for (const Line& line : lines) {
        if (line.normal.dot(r) < line.offset) return false;
      }
      return true;
    }
  };

  static Line line(const Vector2d& point, const Vector2d& normal) { return {normal, normal.dot(point)}; }

  static std::vector<Line> lines(const scene::Shape& shape) {
    if (const auto* half = std::get_if<scene::HalfPlane>(&shape)) return {line(half->point, half->normal)};
    const auto* polygon = std::get_if<scene::Polygon>(&shape);
    if (polygon == nullptr || polygon->outside) {
      throw std::invalid_argument("peers know half-planes and convex polygons");
    }
    std::vector<Line> lines;
    const auto& corners = polygon->vertices;  // counter-clockwise
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vector2d side = corners[(i + 1) % corners.size()] - corners[i];
      lines.push_back(line(corners[i], {-side.y(), side.x()}));
    }
    return lines;
  }

  bool base_;
  std::vector<Region> regions_;
};

}  // namespace hybrid_sphere::peers
