#pragma once

#include <Eigen/LU>
#include <complex>

#include "motion/chebyshev.hpp"

namespace hybrid_sphere {

/// Complex linear equations for values on the nodes of chebyshev.hpp. Its file has the only instance of this
/// decomposition, which is expensive to compile.
class CollocationLu {
 public:
  using Square = Eigen::Matrix<std::complex<double>, chebyshev::size, chebyshev::size>;
  using Column = Eigen::Matrix<std::complex<double>, chebyshev::size, 1>;

  explicit CollocationLu(const Square& matrix);

  /// Returns the x with `matrix` x = right.
  Column solve(const Column& right) const;

 private:
  Eigen::PartialPivLU<Square> decomposition_;
};

}  // namespace hybrid_sphere
