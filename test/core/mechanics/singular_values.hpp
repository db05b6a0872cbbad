#pragma once

#include <algorithm>

#include "mechanics/decompositions/right_singular_vectors.hpp"

namespace hybrid_sphere::testing {

/// Returns the min(m, n) singular values of a matrix A (m x n), descending: the lengths of the columns of A
/// V. They have the round-off of the product, some n epsilon |A|.
inline mechanics::Vector singular_values(const mechanics::Matrix& a) {
  const mechanics::Matrix images = a * mechanics::right_singular_vectors(a);
  return images.leftCols(std::min(a.rows(), a.cols())).colwise().norm();
}

/// Returns the condition number of a matrix of full rank.
inline double condition_number(const mechanics::Matrix& a) {
  const mechanics::Vector values = singular_values(a);
  return values[0] / values[values.size() - 1];
}

}  // namespace hybrid_sphere::testing
