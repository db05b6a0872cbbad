#pragma once

#include "hybrid_sphere/mechanics/equations_of_motion.hpp"

namespace hybrid_sphere::mechanics {

/// Eigenvalues (n) and, as columns, their eigenvectors (n x n).
struct Eigenvectors {
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors;
};

/// Those of a real matrix (n x n); of a conjugate pair, the eigenvalue with a positive imaginary part comes
/// first. Throws NumericalError if the iteration does not converge or overflows.
Eigenvectors eigenvectors(const Matrix& a);

}  // namespace hybrid_sphere::mechanics
