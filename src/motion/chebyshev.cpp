#include "motion/chebyshev.hpp"

#include <algorithm>
#include <cmath>

namespace hybrid_sphere::chebyshev {
namespace {

void map_values(Maps& m) {
  using Extended = Eigen::Matrix<long double, half, half>;
  constexpr long double pi = 3.14159265358979323846264338327950288L;
  Extended evens, odds, from_even, from_odd, even_integrals, odd_integrals;
  Eigen::Matrix<long double, size, size> derivatives, inverse;
  Eigen::Matrix<long double, 1, half> means;
  for (Eigen::Index i = 0; i < half; ++i) {
    // The node is the cosine of odd pi/(2 size); multiples of that are reduced to a revolution.
    constexpr Eigen::Index revolution = Eigen::Index{4} * size;
    const Eigen::Index odd = 2 * (half - i) - 1;
    const auto multiple = [odd](Eigen::Index k) {
      return pi * static_cast<long double>(k * odd % revolution) / (2 * size);
    };
    const auto t = [&](Eigen::Index k) { return std::cos(multiple(k)); };
    m.nodes[i] = static_cast<double>(t(1));
    m.nodes[half + i] = -m.nodes[i];
    for (Eigen::Index k = 0; k < size; ++k) {
      const long double sign = k % 2 == 0 ? 1 : -1;
      derivatives(i, k) = k * std::sin(multiple(k)) / std::sin(multiple(1));
      derivatives(half + i, k) = -sign * derivatives(i, k);
      inverse(k, i) = (k == 0 ? 1.0L : 2.0L) / size * t(k);
      inverse(k, half + i) = sign * inverse(k, i);
    }
    for (Eigen::Index n = 0; n < half; ++n) {
      const Eigen::Index k = 2 * n;
      from_even(n, i) = 2 * inverse(k, i);
      from_odd(n, i) = 2 * inverse(k + 1, i);
      even_integrals(i, n) = k == 0 ? t(1) : (t(k + 1) / (k + 1) - t(k - 1) / (k - 1)) / 2;
      const long double at_zero = n % 2 == 0 ? 1 : -1;  // T_k(0); that of T_{k + 2} is the opposite
      odd_integrals(i, n) =
          k == 0 ? (t(2) + 1) / 4 : ((t(k + 2) + at_zero) / (k + 2) - (t(k) - at_zero) / k) / 2;
      means[n] = 1 / (1.0L - k * k);
    }
  }
  m.even_coefficients = from_even.cast<double>();
  m.odd_coefficients = from_odd.cast<double>();
  m.integral_of_even = (even_integrals * from_even).cast<double>();
  m.integral_of_odd = (odd_integrals * from_odd).cast<double>();
  m.derivative = (derivatives * inverse).cast<double>();
  m.weights << (0.5L * means * from_even).transpose().cast<double>(),
      (0.5L * means * from_even).transpose().cast<double>();
}

void map_coefficients(Maps& m) {
  Square powers = Square::Zero();
  powers(0, 0) = powers(1, 1) = 1;
  for (Eigen::Index k = 2; k < size; ++k) {
    powers.col(k) = -powers.col(k - 2);
    powers.col(k).tail<size - 1>() += 2 * powers.col(k - 1).head<size - 1>();
  }
  for (Eigen::Index n = 0; n < half; ++n) {
    for (Eigen::Index i = 0; i < half; ++i) {
      m.even_powers(n, i) = powers(2 * n, 2 * i);
      m.odd_powers(n, i) = powers(2 * n + 1, 2 * i + 1);
    }
  }
}

Maps make_maps() {
  Maps m;
  map_values(m);
  map_coefficients(m);
  return m;
}

template <int columns>
Parts<columns> parts_of(const Table<columns>& values) {
  return {0.5 * (values.template topRows<half>() + values.template bottomRows<half>()),
          0.5 * (values.template topRows<half>() - values.template bottomRows<half>())};
}

}  // namespace

const Maps& maps() {
  static const Maps maps = make_maps();
  return maps;
}

template <int columns>
Table<columns> integral_of(const Table<columns>& f) {
  using Half = typename Parts<columns>::Half;
  const Parts<columns> parts = parts_of(f);
  const Half odd = maps().integral_of_even.lazyProduct(parts.even);
  const Half even = maps().integral_of_odd.lazyProduct(parts.odd);
  Table<columns> integral;
  integral << even + odd, even - odd;
  return integral;
}

template <int columns>
Parts<columns> coefficients_of(const Table<columns>& f) {
  const Parts<columns> parts = parts_of(f);
  return {maps().even_coefficients.lazyProduct(parts.even), maps().odd_coefficients.lazyProduct(parts.odd)};
}

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

template <int columns>
double left_out(const Parts<columns>& c, Eigen::Index first, Eigen::Index count) {
  const auto size_of = [&](Eigen::Index n) {
    return std::max(c.even.row(n).segment(first, count).norm(), c.odd.row(n).segment(first, count).norm());
  };
  const double last = size_of(half - 1);
  return last > 0 ? last * std::min(1.0, std::sqrt(last / size_of(half - 2))) : 0;
}

template Table<4> integral_of(const Table<4>&);
template Parts<4> coefficients_of(const Table<4>&);
template Table<4> powers_of(const Parts<4>&);
template double left_out(const Parts<4>&, Eigen::Index, Eigen::Index);
template Parts<12> coefficients_of(const Table<12>&);
template Table<12> powers_of(const Parts<12>&);
template double left_out(const Parts<12>&, Eigen::Index, Eigen::Index);

}  // namespace hybrid_sphere::chebyshev
