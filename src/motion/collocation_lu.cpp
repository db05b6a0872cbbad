#include "motion/collocation_lu.hpp"

#include <utility>

#include "motion/phi.hpp"

namespace hybrid_sphere {
namespace {

/// a/b, accurate to a few roundings for numbers whose squares do not overflow.
Complex quotient(const Complex& a, const Complex& b) {
  const Complex product = times(a, std::conj(b));
  const double square = b.real() * b.real() + b.imag() * b.imag();
  return {product.real() / square, product.imag() / square};
}

/// The row with the largest element of a column, from a row on.
std::size_t pivot_of(const CollocationLu::Column& column, std::size_t first) {
  std::size_t pivot = first;
  double largest = std::abs(column[first]);
  for (std::size_t i = first + 1; i < column.size(); ++i) {
    const double element = std::abs(column[i]);
    if (element > largest) {
      largest = element;
      pivot = i;
    }
  }
  return pivot;
}

}  // namespace

CollocationLu::CollocationLu(const Square& matrix) : factors_(matrix) {
  for (std::size_t k = 0; k < size; ++k) {
    Column& eliminated = factors_[k];
    rows_[k] = pivot_of(eliminated, k);
    for (Column& column : factors_) std::swap(column[k], column[rows_[k]]);
    if (eliminated[k] == 0.0) continue;
    for (std::size_t i = k + 1; i < size; ++i) eliminated[i] = quotient(eliminated[i], eliminated[k]);
    for (std::size_t j = k + 1; j < size; ++j) {
      Column& column = factors_[j];
      for (std::size_t i = k + 1; i < size; ++i) column[i] -= times(eliminated[i], column[k]);
    }
  }
}

// By halves: the sum over one half of the unknowns is subtracted from the other half at once.
CollocationLu::Column CollocationLu::solve(const Column& right) const {
  constexpr std::size_t half = size / 2;
  Column x = right;
  for (std::size_t k = 0; k < size; ++k) std::swap(x[k], x[rows_[k]]);
  const auto subtract_half = [&](std::size_t known, std::size_t unknown) {
    Column sum{};
    for (std::size_t k = known; k < known + half; ++k) {
      for (std::size_t i = unknown; i < unknown + half; ++i) sum[i] += times(factors_[k][i], x[k]);
    }
    for (std::size_t i = unknown; i < unknown + half; ++i) x[i] -= sum[i];
  };
  const auto substitute_forward = [&](std::size_t first) {
    for (std::size_t k = first; k < first + half; ++k) {
      for (std::size_t i = k + 1; i < first + half; ++i) x[i] -= times(x[k], factors_[k][i]);
    }
  };
  const auto substitute_backward = [&](std::size_t first) {
    for (std::size_t k = first + half; k-- > first;) {
      x[k] /= factors_[k][k];
      for (std::size_t i = first; i < k; ++i) x[i] -= times(x[k], factors_[k][i]);
    }
  };
  substitute_forward(0);
  subtract_half(0, half);
  substitute_forward(half);
  substitute_backward(half);
  subtract_half(half, 0);
  substitute_backward(0);
  return x;
}

}  // namespace hybrid_sphere
