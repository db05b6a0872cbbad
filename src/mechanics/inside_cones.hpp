#pragma once

#include <vector>

#include "hybrid_sphere/mechanics/equations_of_motion.hpp"

namespace hybrid_sphere::mechanics {

/// abs(w + B x) <= u + s x. Without rows of B it is a half-space.
struct SecondOrderCone {
  double u = 0;
  Vector s;  ///< (k)
  Vector w;  ///< (m)
  Matrix B;  ///< (m x k), m at most 2
};

/// Returns the x (k) near 0 that is well inside of all cones: the minimum of x x/2 - part sum log((u + s x)^2
/// - (w + B x)^2), which changes smoothly with them. Where they have no common inside: the x that misses
/// least. Units are those in which s, B and the way to the cones are about 1.
/// Source: barrier method, Boyd and Vandenberghe, Convex Optimization, 2004, 11.
Vector inside_cones(const std::vector<SecondOrderCone>& cones, Index dimensions);

}  // namespace hybrid_sphere::mechanics
