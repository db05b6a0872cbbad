#pragma once

#include <Eigen/Core>

#include "motion/polynomials.hpp"

namespace hybrid_sphere::chebyshev {

/// Polynomials of degree 15 from values on 16 Chebyshev nodes in [-1, 1]: first the positive nodes,
/// ascending, then their opposites. A function is kept as its even and its odd part where a map takes one
/// into one.
constexpr int size = polynomials::size;
constexpr int half = size / 2;

using Square = Eigen::Matrix<double, size, size>;
using HalfSquare = Eigen::Matrix<double, half, half>;
using Column = Eigen::Matrix<double, size, 1>;
/// Values on the nodes, or coefficients, of several functions.
template <int columns>
using Table = Eigen::Matrix<double, size, columns>;

/// Linear maps of values on the nodes, rounded once.
struct Maps {
  Column nodes;
  HalfSquare even_coefficients;  ///< of T_0, T_2 ..., from the even part
  HalfSquare odd_coefficients;   ///< of T_1, T_3 ..., from the odd part
  HalfSquare even_powers;        ///< from those, the coefficients of 1, x^2 ...
  HalfSquare odd_powers;         ///< of x, x^3 ...
  HalfSquare integral_of_even;   ///< from 0, odd
  HalfSquare integral_of_odd;    ///< from 0, even
  Square derivative;             ///< on the nodes
  Column weights;                ///< of the mean
};
const Maps& maps();

/// Functions on the nodes, or their coefficients, as two parts.
template <int columns>
struct Parts {
  using Half = Eigen::Matrix<double, half, columns>;
  Half even;
  Half odd;
};

namespace detail {
void integrate(const double* values, double* integral);
void find_coefficients(const double* values, double* even, double* odd);
void find_powers(const double* even, const double* odd, double* powers);
double left_out(const double* even, const double* odd, Eigen::Index count);
}  // namespace detail

/// The mean of a function, from its values on the nodes.
double mean_of(const double* values);

/// From 0.
template <int columns>
Table<columns> integral_of(const Table<columns>& f) {
  Table<columns> integral;
  for (int i = 0; i < columns; ++i) detail::integrate(f.data() + i * size, integral.data() + i * size);
  return integral;
}

/// Of the Chebyshev polynomials.
template <int columns>
Parts<columns> coefficients_of(const Table<columns>& f) {
  Parts<columns> c;
  for (int i = 0; i < columns; ++i) {
    detail::find_coefficients(f.data() + i * size, c.even.data() + i * half, c.odd.data() + i * half);
  }
  return c;
}

/// Of the powers of x, in ascending order, from those of the Chebyshev polynomials.
/// @return a row for each function
template <int columns>
polynomials::Powers<columns> powers_of(const Parts<columns>& c) {
  polynomials::Powers<columns> powers;
  double column[size];
  for (int i = 0; i < columns; ++i) {
    detail::find_powers(c.even.data() + i * half, c.odd.data() + i * half, column);
    for (int k = 0; k < size; ++k) powers(i, k) = column[k];
  }
  return powers;
}

/// The size of what the series of a vector leave out: the last two coefficients, as one of them may vanish by
/// symmetry, and how much smaller than the two before them they are.
/// @param first, count  the columns of the vector
template <int columns>
double left_out(const Parts<columns>& c, Eigen::Index first, Eigen::Index count) {
  return detail::left_out(c.even.data() + first * half, c.odd.data() + first * half, count);
}

}  // namespace hybrid_sphere::chebyshev
