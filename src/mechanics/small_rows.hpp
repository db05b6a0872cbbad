#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>
#include <vector>

/// Operations on short rows of numbers. Size is a number, or a type whose value it is, for which the compiler
/// unrolls the loops.
namespace hybrid_sphere::mechanics {

template <class Size>
constexpr bool is_known = !std::is_same_v<Size, std::size_t>;

/// Calls function(size), with a type instead of a number for the sizes that most systems have.
template <class Function>
auto with_size(std::size_t size, Function function) {
  switch (size) {
    case 1: return function(std::integral_constant<std::size_t, 1>());
    case 2: return function(std::integral_constant<std::size_t, 2>());
    case 3: return function(std::integral_constant<std::size_t, 3>());
    case 4: return function(std::integral_constant<std::size_t, 4>());
    case 5: return function(std::integral_constant<std::size_t, 5>());
    case 6: return function(std::integral_constant<std::size_t, 6>());
    default: return function(size);
  }
}

/// Work space of a size: of its own, which fits into registers, where the compiler knows the size.
template <class Size>
struct WorkSpace {
  explicit WorkSpace(std::vector<double>& /*shared*/) {}
  double* data() { return numbers.data(); }
  std::array<double, Size::value> numbers;
};
template <>
struct WorkSpace<std::size_t> {
  explicit WorkSpace(std::vector<double>& shared) : numbers(&shared) {}
  double* data() { return numbers->data(); }
  std::vector<double>* numbers;
};

/// The sum of a_i b_i over the first `length` numbers of rows of this size.
template <class Size>
double dot(const double* a, const double* b, std::size_t length, Size /*size*/) {
  if constexpr (!is_known<Size>) {
    constexpr std::size_t long_enough = 8;  // for Eigen's vectors
    if (length >= long_enough) {
      const auto count = static_cast<Eigen::Index>(length);
      return Eigen::Map<const Eigen::VectorXd>(a, count).dot(Eigen::Map<const Eigen::VectorXd>(b, count));
    }
  }
  double sum = 0;
  for (std::size_t i = 0; i < length; ++i) sum += a[i] * b[i];
  return sum;
}

/// The same over all of it, with a sum for even and one for odd i, which are added at the same time.
template <class Size>
double dot_in_pairs(const double* a, const double* b, Size size) {
  if constexpr (is_known<Size>) {
    if constexpr (Size::value % 2 == 0) {
      using Row = Eigen::Matrix<double, static_cast<int>(Size::value), 1>;
      return Eigen::Map<const Row>(a).dot(Eigen::Map<const Row>(b));
    }
  }
  return dot(a, b, size, size);
}

/// x += factor y
template <class Size>
void add(double factor, const double* y, Size size, double* x) {
  for (std::size_t i = 0; i < size; ++i) x[i] += factor * y[i];
}

/// Solves L x = x, in place, for a row L_i of these below the diagonal.
template <class Size>
void solve_lower(const double* rows, std::size_t stride, Size size, double* x) {
  for (std::size_t i = 1; i < size; ++i) x[i] -= dot(rows + i * stride, x, i, size);
}

/// Solves L^T x = x likewise.
template <class Size>
void solve_upper(const double* rows, std::size_t stride, Size size, double* x) {
  for (std::size_t i = size; i-- > 1;) add(-x[i], rows + i * stride, i, x);
}

/// Decomposes the lower triangle of a block in place. `diagonal` is that of the whole matrix: what has been
/// eliminated before has reduced that of the block.
/// @param of_ld  work space for a row of L D
/// @param least_pivot  relative to the diagonal
/// @return  the smallest pivot relative to the diagonal; 0 if it is too small
template <class Size>
double pivots(double* rows, std::size_t stride, Size size, const double* diagonal, double* inverse,
              double* of_ld, double least_pivot) {
  // Beyond, squares leave the range of numbers.
  constexpr double smallest = 1e-120;
  constexpr double largest = 1e120;
  double least = 1;
  for (std::size_t i = 0; i < size; ++i) {
    double* const row = rows + i * stride;
    double pivot = row[i];
    for (std::size_t j = 0; j < i; ++j) {
      of_ld[j] = row[j] - dot(of_ld, rows + j * stride, j, size);
      row[j] = of_ld[j] * inverse[j];
      pivot -= of_ld[j] * row[j];
    }
    const bool is_in_range = diagonal[i] > smallest && diagonal[i] < largest;
    if (!is_in_range || !(pivot > least_pivot * diagonal[i])) return 0;
    inverse[i] = 1 / pivot;
    least = std::min(least, pivot / diagonal[i]);
  }
  return least;
}

}  // namespace hybrid_sphere::mechanics
