#pragma once

#include <Eigen/Core>
#include <algorithm>

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

/// The size of what Taylor polynomials of a vector leave out at x = 1, from how its last coefficients fall,
/// if those beyond fall no slower: pairs, as one of two may vanish by symmetry.
/// In the maximum norm, which is the same for a vector turned by a right angle.
/// @param first, count  its rows
template <int rows>
double left_out(const Powers<rows>& powers, Eigen::Index first, Eigen::Index count) {
  const auto size_of = [&](Eigen::Index k) {
    return powers.col(k).segment(first, count).cwiseAbs().maxCoeff();
  };
  const double last = std::max(size_of(size - 1), size_of(size - 2));
  const double before = std::max(size_of(size - 3), size_of(size - 4));
  return last > 0 ? last * std::min(1.0, last / before) : 0;
}

}  // namespace hybrid_sphere::polynomials
