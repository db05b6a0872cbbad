#include "mechanics/decompositions/right_singular_vectors.hpp"

#include <Eigen/SVD>

namespace hybrid_sphere::mechanics {

Matrix right_singular_vectors(const Matrix& a) {
  return Eigen::JacobiSVD<Matrix>(a, Eigen::ComputeFullV).matrixV();
}

}  // namespace hybrid_sphere::mechanics
