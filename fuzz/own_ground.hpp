#pragma once

#include <vector>

#include "own_motion.hpp"

namespace hybrid_sphere::fuzz::own {

constexpr int base = -1;  ///< the ground under all regions
constexpr int no_region = -2;

/// A straight line or a circle that an edge is a part of; positive on one side.
struct Edge {
  Vec2 point;
  Vec2 normal;      // of length 1; of a line
  Real radius = 0;  // of a circle

  Real at(const Vec2& r) const { return radius > 0 ? (r - point).norm() - radius : normal.dot(r - point); }
  Real rate(const Body& body) const {
    return radius > 0 ? (body.r - point).normalized().dot(body.v) : normal.dot(body.v);
  }
};

/// Of all regions.
std::vector<Edge> edges_of(const scene::Surface& surface);

/// Whether a region is visible at a place, and which one is on top there.
/// @param slack  distance from an edge that counts as on it [m]
bool is_visible(const scene::Surface& surface, const Vec2& r, int region, Real slack, int& top);

}  // namespace hybrid_sphere::fuzz::own
