#include "mechanics/decompositions/cholesky.hpp"

namespace hybrid_sphere::mechanics {

bool Cholesky::compute(const Matrix& a) {
  llt_.compute(a);
  return llt_.info() == Eigen::Success;
}

void Cholesky::solve(Eigen::Ref<Eigen::VectorXd> x) const { llt_.solveInPlace(x); }

void Cholesky::solve_l(Eigen::Ref<Eigen::VectorXd> x) const { llt_.matrixL().solveInPlace(x); }

void Cholesky::solve_l_transposed(Eigen::Ref<Eigen::VectorXd> x) const { llt_.matrixU().solveInPlace(x); }

void Cholesky::solve(Matrix& x) const { llt_.solveInPlace(x); }

void Cholesky::solve_l(Matrix& x) const { llt_.matrixL().solveInPlace(x); }

}  // namespace hybrid_sphere::mechanics
