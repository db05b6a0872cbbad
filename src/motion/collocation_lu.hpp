#pragma once

#include <Eigen/LU>
#include <array>
#include <complex>

#include "motion/polynomials.hpp"

namespace hybrid_sphere {

/// Complex linear equations for values on the nodes of chebyshev.hpp. Its file has the only instance of this
/// decomposition, which is expensive to compile.
class CollocationLu {
 public:
  using Column = std::array<std::complex<double>, polynomials::size>;
  using Square = std::array<Column, polynomials::size>;  ///< by columns

  explicit CollocationLu(const Square& matrix);

  /// The x with matrix x = right.
  Column solve(const Column& right) const;

 private:
  using Matrix = Eigen::Matrix<std::complex<double>, polynomials::size, polynomials::size>;

  Eigen::PartialPivLU<Matrix> decomposition_;
};

}  // namespace hybrid_sphere
