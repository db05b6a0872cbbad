#pragma once

#include <Eigen/QR>

#include "hybrid_sphere/mechanics/equations_of_motion.hpp"

namespace hybrid_sphere::mechanics {

/// Decomposition A P = Q R of a matrix A (m x n) by reflections, with a permutation P that makes the diagonal
/// of R descend in absolute value.
class PivotedQr {
 public:
  PivotedQr() = default;
  explicit PivotedQr(const Matrix& a) { compute(a); }

  void compute(const Matrix& a);

  /// R in the upper triangle (m x n).
  const Matrix& r() const { return qr_.matrixQR(); }

  /// The column of A that is column `i` of A P.
  Index column(Index i) const { return qr_.colsPermutation().indices()[i]; }

  /// Sets `q` to Q (m x m).
  void evaluate_q(Matrix& q);

  /// Replaces X by Q X (m x k).
  void apply_q(Matrix& x);

  /// Solves R x = b or R^T x = b in place, with the leading square of R that has the size of x.
  void solve_r(Eigen::Ref<Eigen::VectorXd> x) const;
  void solve_r_transposed(Eigen::Ref<Eigen::VectorXd> x) const;

  /// Returns an x (n) that minimizes |A x - b|.
  Vector solve(const Vector& b);

 private:
  Eigen::ColPivHouseholderQR<Matrix> qr_;
  Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor> workspace_;
};

}  // namespace hybrid_sphere::mechanics
