#include "mechanics/decompositions/pivoted_qr.hpp"

namespace hybrid_sphere::mechanics {

// Reflections are applied to one type of matrix with one type of workspace, also if it has one column: each
// further type takes more than a second to compile.

void PivotedQr::compute(const Matrix& a) { qr_.compute(a); }

void PivotedQr::evaluate_q(Matrix& q) {
  q.setIdentity(qr_.rows(), qr_.rows());
  qr_.householderQ().applyThisOnTheLeft(q, workspace_, true);
}

void PivotedQr::apply_q(Matrix& x) { qr_.householderQ().applyThisOnTheLeft(x, workspace_); }

void PivotedQr::solve_r(Eigen::Ref<Eigen::VectorXd> x) const {
  qr_.matrixQR().topLeftCorner(x.size(), x.size()).triangularView<Eigen::Upper>().solveInPlace(x);
}

void PivotedQr::solve_r_transposed(Eigen::Ref<Eigen::VectorXd> x) const {
  qr_.matrixQR().topLeftCorner(x.size(), x.size()).triangularView<Eigen::Upper>().transpose().solveInPlace(x);
}

Vector PivotedQr::solve(const Vector& b) {
  Vector x = Vector::Zero(qr_.cols());
  const Index pivots = qr_.nonzeroPivots();
  if (pivots == 0) return x;
  Matrix c = b;
  qr_.householderQ().setLength(pivots).transpose().applyThisOnTheLeft(c, workspace_);
  solve_r(c.col(0).head(pivots));
  for (Index i = 0; i < pivots; ++i) x[column(i)] = c(i, 0);
  return x;
}

}  // namespace hybrid_sphere::mechanics
