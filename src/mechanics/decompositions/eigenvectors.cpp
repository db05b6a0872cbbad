#include "mechanics/decompositions/eigenvectors.hpp"

#include <Eigen/Eigenvalues>

#include "hybrid_sphere/numerical_error.hpp"

namespace hybrid_sphere::mechanics {

Eigenvectors eigenvectors(const Matrix& a) {
  if (a.size() == 0) return {Eigen::VectorXcd(0), Eigen::MatrixXcd(0, 0)};
  const Eigen::EigenSolver<Matrix> solver(a);
  if (solver.info() != Eigen::Success) throw NumericalError("the eigenvectors of a matrix do not converge");
  Eigenvectors found{solver.eigenvalues(), solver.eigenvectors()};
  if (!(found.values.allFinite() && found.vectors.allFinite())) {
    throw NumericalError("the eigenvectors of a matrix are not finite");
  }
  return found;
}

}  // namespace hybrid_sphere::mechanics
