#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace hybrid_sphere::polynomials {

/// Coefficients of several polynomials of degree 15, a column for each power, ascending.
constexpr int size = 16;
template <int rows>
using Powers = Eigen::Matrix<double, rows, size>;

namespace detail {
void evaluate4(const double* powers, double x, double* values);
void evaluate8(const double* powers, double x, double* values);
void evaluate12(const double* powers, double x, double* values);
void follow(const double* rates, int terms, int count, double* quaternions);
void multiply4(const double* matrix, double* powers);
double economize4(const double* powers, double* economized);
}  // namespace detail

/// Taylor polynomials of a quaternion to a degree beyond which nothing is seen where it turns by a few
/// radians.
constexpr int long_size = 24;
using LongPowers = Eigen::Matrix<double, 4, long_size>;

/// A quaternion q that obeys q' = (0, w) q: all powers from the first one, by
/// (n + 1) q_(n+1) = (0, w_0) q_n + ... + (0, w_n) q_0.
/// @param rates        powers of w
/// @param terms        how many of them there are, > 0; all others vanish
/// @param count        of columns that are wanted; all further ones are set to 0
/// @param quaternions  (x, y, z, w), with the first column set
inline void follow(const Powers<3>& rates, int terms, int count, LongPowers& quaternions) {
  detail::follow(rates.data(), terms, count, quaternions.data());
  std::fill(quaternions.data() + Eigen::Index{4} * count, quaternions.data() + Eigen::Index{4} * long_size,
            0.0);
}

/// Their economization on [-1, 1]: the polynomials of degree 15 without the Chebyshev polynomials of higher
/// degree.
/// @return the size of what that leaves out: the first two coefficients
inline double economize(const LongPowers& powers, Powers<4>& economized) {
  return detail::economize4(powers.data(), economized.data());
}

/// powers = matrix powers
inline void multiply(const Eigen::Matrix4d& matrix, Powers<4>& powers) {
  detail::multiply4(matrix.data(), powers.data());
}

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
    const double* const power = powers.data() + k * rows + first;
    double largest = std::abs(power[0]);
    for (Eigen::Index i = 1; i < count; ++i) largest = std::max(largest, std::abs(power[i]));
    return largest;
  };
  const double last = std::max(size_of(size - 1), size_of(size - 2));
  const double before = std::max(size_of(size - 3), size_of(size - 4));
  return last > 0 ? last * std::min(1.0, last / before) : 0;
}

}  // namespace hybrid_sphere::polynomials
