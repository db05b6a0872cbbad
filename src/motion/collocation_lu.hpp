#pragma once

#include <array>
#include <complex>
#include <cstddef>

#include "motion/polynomials.hpp"

namespace hybrid_sphere {

/// Complex linear equations for values on the nodes of chebyshev.hpp: an LU decomposition with partial
/// pivoting. It is written out because Eigen's takes long to compile.
class CollocationLu {
 public:
  static constexpr std::size_t size = polynomials::size;
  using Column = std::array<std::complex<double>, size>;
  using Square = std::array<Column, size>;  ///< by columns

  explicit CollocationLu(const Square& matrix);

  /// Returns the x with `matrix` x = right.
  Column solve(const Column& right) const;

 private:
  Square factors_;                      // U, and below its diagonal L without the ones of its own
  std::array<std::size_t, size> rows_;  // with which each row has been exchanged
};

}  // namespace hybrid_sphere
