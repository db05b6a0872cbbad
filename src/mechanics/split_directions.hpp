#pragma once

#include "hybrid_sphere/mechanics/equations_of_motion.hpp"

namespace hybrid_sphere::mechanics {

/// Orthonormal directions x (n), those that a matrix takes to 0 and the others.
struct SplitDirections {
  Matrix kernel;  ///< (n x (n - r))
  Matrix rest;    ///< (n x r), singular vectors: the columns of A rest are orthogonal
};

/// @param a          A (m x n), m >= 0
/// @param threshold  singular values up to this are 0
SplitDirections split_directions(const Matrix& a, double threshold);

}  // namespace hybrid_sphere::mechanics
