#include "motion/chebyshev.hpp"

#include <algorithm>
#include <cmath>

namespace hybrid_sphere::chebyshev {
namespace {

template <std::size_t rows, std::size_t columns>
using Extended = long double[rows][columns];

/// An element of the product of two matrices, from a row of the first one and column j of the second one.
template <std::size_t depth, std::size_t columns>
double element(const long double (&row)[depth], const Extended<depth, columns>& matrix, int j) {
  long double sum = 0;
  for (std::size_t k = 0; k < depth; ++k) sum += row[k] * matrix[k][j];
  return static_cast<double>(sum);
}

void map_values(Maps& m) {
  constexpr long double pi = 3.14159265358979323846264338327950288L;
  Extended<half, half> from_even, from_odd, even_integrals, odd_integrals;
  Extended<size, size> derivatives, inverse;
  long double means[half];
  for (int i = 0; i < half; ++i) {
    // The node is the cosine of odd pi/(2 size); multiples of that are reduced to a revolution.
    constexpr int revolution = 4 * size;
    const int odd = 2 * (half - i) - 1;
    const auto multiple = [odd](int k) {
      return pi * static_cast<long double>(k * odd % revolution) / (2 * size);
    };
    const auto t = [&](int k) { return std::cos(multiple(k)); };
    m.nodes[i] = static_cast<double>(t(1));
    m.nodes[half + i] = -m.nodes[i];
    for (int k = 0; k < size; ++k) {
      const long double sign = k % 2 == 0 ? 1 : -1;
      derivatives[i][k] = k * std::sin(multiple(k)) / std::sin(multiple(1));
      derivatives[half + i][k] = -sign * derivatives[i][k];
      inverse[k][i] = (k == 0 ? 1.0L : 2.0L) / size * t(k);
      inverse[k][half + i] = sign * inverse[k][i];
    }
    for (int n = 0; n < half; ++n) {
      const int k = 2 * n;
      from_even[n][i] = 2 * inverse[k][i];
      from_odd[n][i] = 2 * inverse[k + 1][i];
      even_integrals[i][n] = k == 0 ? t(1) : (t(k + 1) / (k + 1) - t(k - 1) / (k - 1)) / 2;
      const long double at_zero = n % 2 == 0 ? 1 : -1;  // T_k(0); that of T_{k + 2} is the opposite
      odd_integrals[i][n] =
          k == 0 ? (t(2) + 1) / 4 : ((t(k + 2) + at_zero) / (k + 2) - (t(k) - at_zero) / k) / 2;
      means[n] = 0.5L * (1 / (1.0L - k * k));
    }
  }
  for (int j = 0; j < half; ++j) {
    for (int i = 0; i < half; ++i) {
      m.even_coefficients(i, j) = static_cast<double>(from_even[i][j]);
      m.odd_coefficients(i, j) = static_cast<double>(from_odd[i][j]);
      m.integral_of_even(i, j) = element(even_integrals[i], from_even, j);
      m.integral_of_odd(i, j) = element(odd_integrals[i], from_odd, j);
    }
    m.weights[j] = m.weights[half + j] = element(means, from_even, j);
  }
  for (int j = 0; j < size; ++j) {
    for (int i = 0; i < size; ++i) m.derivative(i, j) = element(derivatives[i], inverse, j);
  }
}

void map_coefficients(Maps& m) {
  double powers[size][size] = {{1}, {0, 1}};  // of the Chebyshev polynomials
  for (int k = 2; k < size; ++k) {
    for (int i = 0; i < size; ++i) {
      powers[k][i] = -powers[k - 2][i];
      if (i > 0) powers[k][i] += 2 * powers[k - 1][i - 1];
    }
  }
  for (Eigen::Index n = 0; n < half; ++n) {
    for (Eigen::Index i = 0; i < half; ++i) {
      m.even_powers(n, i) = powers[2 * i][2 * n];
      m.odd_powers(n, i) = powers[2 * i + 1][2 * n + 1];
    }
  }
}

Maps make_maps() {
  Maps m;
  map_values(m);
  map_coefficients(m);
  return m;
}

/// An even or an odd part on the nodes.
using HalfColumn = Eigen::Matrix<double, half, 1>;

/// matrix column
HalfColumn product(const HalfSquare& matrix, const HalfColumn& column) { return matrix.lazyProduct(column); }

HalfColumn even_part(const double* values) {
  HalfColumn part;
  for (int i = 0; i < half; ++i) part[i] = 0.5 * (values[i] + values[half + i]);
  return part;
}

HalfColumn odd_part(const double* values) {
  HalfColumn part;
  for (int i = 0; i < half; ++i) part[i] = 0.5 * (values[i] - values[half + i]);
  return part;
}

}  // namespace

const Maps& maps() {
  static const Maps maps = make_maps();
  return maps;
}

double mean_of(const double* values) { return maps().weights.dot(Eigen::Map<const Column>(values)); }

void detail::integrate(const double* values, double* integral) {
  const HalfColumn odd = product(maps().integral_of_even, even_part(values));
  const HalfColumn even = product(maps().integral_of_odd, odd_part(values));
  for (int i = 0; i < half; ++i) {
    integral[i] = even[i] + odd[i];
    integral[half + i] = even[i] - odd[i];
  }
}

void detail::find_coefficients(const double* values, double* even, double* odd) {
  const HalfColumn evens = product(maps().even_coefficients, even_part(values));
  const HalfColumn odds = product(maps().odd_coefficients, odd_part(values));
  std::copy_n(evens.data(), half, even);
  std::copy_n(odds.data(), half, odd);
}

void detail::find_powers(const double* even, const double* odd, double* powers) {
  const HalfColumn evens = product(maps().even_powers, HalfColumn(even));
  const HalfColumn odds = product(maps().odd_powers, HalfColumn(odd));
  for (Eigen::Index n = 0; n < half; ++n) {
    powers[2 * n] = evens[n];
    powers[2 * n + 1] = odds[n];
  }
}

double detail::left_out(const double* even, const double* odd, Eigen::Index count) {
  const auto norm = [count](const double* row) {
    double sum = row[0] * row[0];
    for (Eigen::Index i = 1; i < count; ++i) sum += row[i * half] * row[i * half];
    return std::sqrt(sum);
  };
  const double last = std::max(norm(even + half - 1), norm(odd + half - 1));
  const double before = std::max(norm(even + half - 2), norm(odd + half - 2));
  return last > 0 ? last * std::min(1.0, std::sqrt(last / before)) : 0;
}

}  // namespace hybrid_sphere::chebyshev
