#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

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
  explicit Parts(const Table<columns>& values)
      : even(0.5 * (values.template topRows<half>() + values.template bottomRows<half>())),
        odd(0.5 * (values.template topRows<half>() - values.template bottomRows<half>())) {}
  Parts(const Half& even_part, const Half& odd_part) : even(even_part), odd(odd_part) {}
};

/// From 0.
template <int columns>
Table<columns> integral_of(const Table<columns>& f) {
  using Half = typename Parts<columns>::Half;
  const Parts<columns> parts(f);
  const Half odd = maps().integral_of_even.lazyProduct(parts.even);
  const Half even = maps().integral_of_odd.lazyProduct(parts.odd);
  Table<columns> integral;
  integral << even + odd, even - odd;
  return integral;
}

/// Of the Chebyshev polynomials.
template <int columns>
Parts<columns> coefficients_of(const Table<columns>& f) {
  const Parts<columns> parts(f);
  return {maps().even_coefficients.lazyProduct(parts.even), maps().odd_coefficients.lazyProduct(parts.odd)};
}

/// Of the powers of x, in ascending order, from those of the Chebyshev polynomials.
template <int columns>
Table<columns> powers_of(const Parts<columns>& c) {
  using Half = typename Parts<columns>::Half;
  const Half even = maps().even_powers.lazyProduct(c.even);
  const Half odd = maps().odd_powers.lazyProduct(c.odd);
  Table<columns> powers;
  for (Eigen::Index n = 0; n < half; ++n) {
    powers.row(2 * n) = even.row(n);
    powers.row(2 * n + 1) = odd.row(n);
  }
  return powers;
}

/// The size of what the series of a vector leave out: the last two coefficients, as one of them may vanish by
/// symmetry, and how much smaller than the two before them they are.
/// @param first, count  the columns of the vector
template <int columns>
double left_out(const Parts<columns>& c, Eigen::Index first, Eigen::Index count) {
  const auto size_of = [&](Eigen::Index n) {
    return std::max(c.even.row(n).segment(first, count).norm(), c.odd.row(n).segment(first, count).norm());
  };
  const double last = size_of(half - 1);
  return last > 0 ? last * std::min(1.0, std::sqrt(last / size_of(half - 2))) : 0;
}

}  // namespace hybrid_sphere::chebyshev
