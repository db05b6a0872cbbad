#pragma once

#include <Eigen/QR>

#include "hybrid_sphere/mechanics/equations_of_motion.hpp"

namespace hybrid_sphere::mechanics {

/// Complete orthogonal decomposition of a matrix A (m x n) of any rank.
class LeastNorm {
 public:
  explicit LeastNorm(const Matrix& a);

  /// Returns the shortest of all x (n) that minimize |A x - b|.
  Vector solve(const Vector& b) const;

 private:
  Eigen::CompleteOrthogonalDecomposition<Matrix> decomposition_;
};

}  // namespace hybrid_sphere::mechanics
