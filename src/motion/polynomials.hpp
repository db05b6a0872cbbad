#pragma once

#include <Eigen/Core>

namespace hybrid_sphere::polynomials {

/// Coefficients of several polynomials of degree 15, a column for each power, ascending.
constexpr int size = 16;
template <int rows>
using Powers = Eigen::Matrix<double, rows, size>;

namespace detail {
void evaluate4(const double* powers, double x, double* values);
void evaluate8(const double* powers, double x, double* values);
void evaluate12(const double* powers, double x, double* values);
}  // namespace detail

/// Their values at x. Where the processor has AVX, four at a time, to the same bits.
template <int rows>
Eigen::Matrix<double, rows, 1> values(const Powers<rows>& powers, double x) {
  static_assert(rows == 4 || rows == 8 || rows == 12);
  constexpr auto evaluate = rows == 4   ? detail::evaluate4
                            : rows == 8 ? detail::evaluate8
                                        : detail::evaluate12;
  Eigen::Matrix<double, rows, 1> values;
  evaluate(powers.data(), x, values.data());
  return values;
}

}  // namespace hybrid_sphere::polynomials
