#include "mechanics/decompositions/eigenvalues.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "hybrid_sphere/numerical_error.hpp"

namespace hybrid_sphere::mechanics {

// The steps and formulas of Eigen::EigenSolver, which takes longer to compile because it can compute
// eigenvectors: each diagonal block of the real Schur form has one eigenvalue or two.
Eigen::VectorXcd eigenvalues(const Matrix& a) {
  const double scale = a.cwiseAbs().maxCoeff();
  const Index size = a.cols();
  if (scale < std::numeric_limits<double>::min()) return Eigen::VectorXcd::Zero(size);
  const Eigen::HessenbergDecomposition<Matrix> hessenberg(a / scale);
  Eigen::RealSchur<Matrix> schur(size);
  schur.computeFromHessenberg(Matrix(hessenberg.matrixH()), Matrix(), false);
  if (schur.info() != Eigen::Success) throw NumericalError("the eigenvalues of a matrix do not converge");
  const Matrix t = schur.matrixT() * scale;
  Eigen::VectorXcd values(size);
  for (Index i = 0; i < size; ++i) {
    if (i == size - 1 || t(i + 1, i) == 0) {
      values[i] = t(i, i);
    } else {
      const double half_difference = 0.5 * (t(i, i) - t(i + 1, i + 1));
      const double largest =
          std::max({std::abs(half_difference), std::abs(t(i + 1, i)), std::abs(t(i, i + 1))});
      const double scaled = half_difference / largest;
      const double imaginary =
          largest * std::sqrt(std::abs(scaled * scaled + (t(i + 1, i) / largest) * (t(i, i + 1) / largest)));
      values[i] = {t(i + 1, i + 1) + half_difference, imaginary};
      values[i + 1] = std::conj(values[i]);
      ++i;
    }
  }
  if (!values.allFinite()) throw NumericalError("the eigenvalues of a matrix are not finite");
  return values;
}

}  // namespace hybrid_sphere::mechanics
