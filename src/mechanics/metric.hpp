#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace hybrid_sphere::mechanics {

/// x.Mx, for a symmetric M (n x n).
inline double squared_length(const Eigen::MatrixXd& mass, const Eigen::VectorXd& x) {
  double sum = 0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    double row = 0;
    for (Eigen::Index j = 0; j < x.size(); ++j) row += mass(j, i) * x[j];
    sum += row * x[i];
  }
  return sum;
}

/// The length of x in the metric of M, for which rounding may have made x.Mx negative.
inline double length(const Eigen::MatrixXd& mass, const Eigen::VectorXd& x) {
  return std::sqrt(std::max(0.0, squared_length(mass, x)));
}

}  // namespace hybrid_sphere::mechanics
