#pragma once

#include "hybrid_sphere/mechanics/equations_of_motion.hpp"

namespace hybrid_sphere::mechanics {

/// Returns the eigenvalues of a real matrix (n x n); of a conjugate pair, the one with a positive imaginary
/// part comes first. Throws NumericalError if the iteration does not converge or overflows.
Eigen::VectorXcd eigenvalues(const Matrix& a);

}  // namespace hybrid_sphere::mechanics
