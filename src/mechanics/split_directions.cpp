#include "mechanics/split_directions.hpp"

#include "mechanics/decompositions/right_singular_vectors.hpp"

namespace hybrid_sphere::mechanics {

SplitDirections split_directions(const Matrix& a, double threshold) {
  const Index size = a.cols();
  if (a.rows() == 0 || size == 0) return {Matrix::Identity(size, size), Matrix(size, 0)};
  const Matrix directions = right_singular_vectors(a);
  Index rank = 0;
  while (rank < size && (a * directions.col(rank)).norm() > threshold) ++rank;
  return {directions.rightCols(size - rank), directions.leftCols(rank)};
}

}  // namespace hybrid_sphere::mechanics
