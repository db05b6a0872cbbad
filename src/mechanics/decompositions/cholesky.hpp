#pragma once

#include <Eigen/Cholesky>

#include "hybrid_sphere/mechanics/equations_of_motion.hpp"

namespace hybrid_sphere::mechanics {

/// Decomposition A = L L^T of a symmetric matrix (n x n).
class Cholesky {
 public:
  Cholesky() = default;
  explicit Cholesky(const Matrix& a) { compute(a); }

  /// @return  whether A is positive definite
  bool compute(const Matrix& a);

  /// L in the lower triangle (n x n).
  const Matrix& l() const { return llt_.matrixLLT(); }

  /// Solve A x = b, L x = b or L^T x = b in place (n).
  void solve(Eigen::Ref<Eigen::VectorXd> x) const;
  void solve_l(Eigen::Ref<Eigen::VectorXd> x) const;
  void solve_l_transposed(Eigen::Ref<Eigen::VectorXd> x) const;

  /// Solve A X = B or L X = B in place (n x k).
  void solve(Matrix& x) const;
  void solve_l(Matrix& x) const;

 private:
  Eigen::LLT<Matrix> llt_;
};

}  // namespace hybrid_sphere::mechanics
