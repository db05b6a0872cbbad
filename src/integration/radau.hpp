#pragma once

#include <Eigen/Core>

namespace hybrid_sphere::integration {

/// Coefficients of Radau's method IIA of 5 stages: collocation at the nodes c, of which the last one is 1. Of
/// order 9, L-stable, of stage order 5. Source: E. Hairer, G. Wanner, Solving Ordinary Differential Equations
/// II, 2nd ed., Springer 1996, IV.5 (the method), IV.8 (its equations and the estimate of the error).
struct Radau {
  static constexpr Eigen::Index stages = 5;
  using Row = Eigen::Matrix<double, stages, 1>;
  using Square = Eigen::Matrix<double, stages, stages>;
  using ComplexSquare = Eigen::Matrix<std::complex<double>, stages, stages>;

  Row nodes;                   ///< c, ascending
  Square slopes;               ///< A
  Square inverse;              ///< A^-1
  Row start;                   ///< weights by which the slopes of the stages give that of the beginning
  double real_eigenvalue = 0;  ///< the one of A^-1 that is real
  Eigen::Matrix<std::complex<double>, stages, 1> eigenvalues;  ///< of A^-1
  ComplexSquare vectors;                                       ///< V, A^-1 = V diag(eigenvalues) V^-1
  ComplexSquare vectors_inverse;

  /// Lagrange's polynomial that is 1 at node i and 0 at the others; s from 0 to 1.
  double basis(Eigen::Index i, double s) const;
};

/// Shared by all.
const Radau& radau();

}  // namespace hybrid_sphere::integration
