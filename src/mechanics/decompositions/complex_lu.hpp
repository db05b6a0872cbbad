#pragma once

#include <Eigen/LU>

namespace hybrid_sphere::mechanics {

/// Decomposition of a regular complex matrix A (n x n) with partial pivoting.
class ComplexLu {
 public:
  explicit ComplexLu(const Eigen::MatrixXcd& a);

  /// Returns the x with A x = b (n).
  Eigen::VectorXcd solve(const Eigen::VectorXcd& b) const;

 private:
  Eigen::PartialPivLU<Eigen::MatrixXcd> lu_;
};

}  // namespace hybrid_sphere::mechanics
