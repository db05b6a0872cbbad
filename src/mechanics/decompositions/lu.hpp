#pragma once

#include <Eigen/LU>

#include "hybrid_sphere/mechanics/equations_of_motion.hpp"

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

/// Returns the x with A x = b, for a regular matrix A (n x n).
Vector solve_linear_equations(const Matrix& a, const Vector& b);

}  // namespace hybrid_sphere::mechanics
