#pragma once

#include "hybrid_sphere/mechanics/equations_of_motion.hpp"

namespace hybrid_sphere::mechanics {

/// Returns V of the singular value decomposition A = U S V^T, of a matrix A (m x n), with descending singular
/// values: orthonormal columns (n x n), of which the last n - rank span the kernel of A.
Matrix right_singular_vectors(const Matrix& a);

}  // namespace hybrid_sphere::mechanics
