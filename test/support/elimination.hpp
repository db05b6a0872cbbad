#pragma once

#include <Eigen/Core>
#include <cmath>
#include <utility>

namespace hybrid_sphere::testing {

/// Returns the x (n) with A x = b for a regular matrix A (n x n) of any scalar, by Gauss' elimination with
/// the largest pivot of each column. Loops over numbers compile in a fraction of the time of a decomposition
/// of Eigen.
template <class Matrix, class Vector>
Vector solve_by_elimination(Matrix a, Vector b) {
  const Eigen::Index n = b.size();
  for (Eigen::Index k = 0; k < n; ++k) {
    Eigen::Index pivot = k;
    for (Eigen::Index i = k + 1; i < n; ++i) {
      if (std::abs(a(i, k)) > std::abs(a(pivot, k))) pivot = i;
    }
    for (Eigen::Index j = k; j < n; ++j) std::swap(a(k, j), a(pivot, j));
    std::swap(b[k], b[pivot]);
    for (Eigen::Index i = k + 1; i < n; ++i) {
      const auto factor = a(i, k) / a(k, k);
      for (Eigen::Index j = k + 1; j < n; ++j) a(i, j) -= factor * a(k, j);
      b[i] -= factor * b[k];
    }
  }
  for (Eigen::Index k = n; k-- > 0;) {
    for (Eigen::Index j = k + 1; j < n; ++j) b[k] -= a(k, j) * b[j];
    b[k] /= a(k, k);
  }
  return b;
}

}  // namespace hybrid_sphere::testing
