#include "mechanics/schur_complement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

namespace hybrid_sphere::mechanics {
namespace {

// Pivots below this part of the diagonal are left to SaddlePoint.
constexpr double least_pivot = 1.0 / 64;

// Beyond, squares leave the range of numbers.
constexpr double smallest = 1e-120;
constexpr double largest = 1e120;

bool is_in_range(double x) { return x > smallest && x < largest; }

/// Of the first `length` numbers of rows of this size.
template <class Size>
double dot(const double* a, const double* b, std::size_t length, Size /*size*/) {
  if constexpr (std::is_same_v<Size, std::size_t>) {
    constexpr std::size_t long_enough = 8;  // for Eigen's vectors
    if (length >= long_enough) {
      const auto count = static_cast<Index>(length);
      return Eigen::Map<const Eigen::VectorXd>(a, count).dot(Eigen::Map<const Eigen::VectorXd>(b, count));
    }
  }
  double sum = 0;
  for (std::size_t i = 0; i < length; ++i) sum += a[i] * b[i];
  return sum;
}

/// x += factor y
template <class Size>
void add(double factor, const double* y, Size size, double* x) {
  for (std::size_t i = 0; i < size; ++i) x[i] += factor * y[i];
}

/// The first of `end` numbers that is not 0; `end` if there is none.
std::size_t first_nonzero(const double* numbers, std::size_t end) {
  std::size_t i = 0;
  while (i < end && numbers[i] == 0) ++i;
  return i;
}

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

template <class Size>
bool are_finite(const double* numbers, Size size) {
  double zero = 0;
  for (std::size_t i = 0; i < size; ++i) zero += 0 * numbers[i];
  return zero == 0;
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

}  // namespace

/// Whether zeros of M and C are left out: where the compiler does not unroll the loops.
template <class Size>
constexpr bool has_structure(Size /*size*/) {
  return std::is_same_v<Size, std::size_t>;
}

template <class Size>
std::size_t SchurComplement::first_of(const Factor& factor, std::size_t i, Size size) {
  return has_structure(size) ? factor.first[i] : 0;
}

/// Sets the part of the row L^-1 C_b^T that is not 0.
void SchurComplement::set_span(std::size_t b) {
  const double* const image = images_.data() + b * n_;
  std::size_t end = n_;
  while (end > 0 && image[end - 1] == 0) --end;
  spans_[b] = {first_nonzero(image, end), end};
}

/// The part of two of these rows in which neither is 0.
template <class Size>
SchurComplement::Span SchurComplement::common_span(std::size_t a, std::size_t b, Size n) const {
  if (!has_structure(n)) return {0, n};
  const std::size_t begin = std::max(spans_[a].begin, spans_[b].begin);
  const std::size_t end = std::min(spans_[a].end, spans_[b].end);
  return {begin, std::max(begin, end)};
}

void SchurComplement::resize(std::size_t n, std::size_t g) {
  if (n == n_ && g == g_) return;
  n_ = n;
  g_ = g;
  for (Numbers* numbers : {&rows_, &images_, &weighted_}) numbers->resize(g * n);
  mass_.rows.resize(n * n);
  complement_.rows.resize(g * g);
  mass_.first.assign(n, 0);
  complement_.first.assign(g, 0);
  spans_.assign(g, {0, n});
  for (Numbers* numbers : {&mass_.inverse, &mass_.of_row, &velocities_}) numbers->resize(n);
  for (Numbers* numbers : {&complement_.inverse, &complement_.of_row, &multipliers_}) numbers->resize(g);
  tied_.resize(g);
}

/// Decomposes the lower triangle in `factor` in place.
/// @return  the smallest pivot relative to the diagonal; 0 if it is too small
template <class Size>
double SchurComplement::pivots(Factor& factor, Size size) {
  double least = 1;
  for (std::size_t i = 0; i < size; ++i) {
    WorkSpace<Size> work(factor.of_row);
    double* const of_ld = work.data();  // the row of L D
    double* const row = factor.rows.data() + i * size;
    const double diagonal = row[i];
    double pivot = diagonal;
    for (std::size_t j = first_of(factor, i, size); j < i; ++j) {
      const std::size_t from = std::max(first_of(factor, i, size), first_of(factor, j, size));
      const std::size_t count = j > from ? j - from : 0;
      of_ld[j] = row[j] - dot(of_ld + from, factor.rows.data() + j * size + from, count, size);
      row[j] = of_ld[j] * factor.inverse[j];
      pivot -= of_ld[j] * row[j];
    }
    if (!is_in_range(diagonal) || !(pivot > least_pivot * diagonal)) return 0;
    factor.inverse[i] = 1 / pivot;
    least = std::min(least, pivot / diagonal);
  }
  return least;
}

template <class Size>
void SchurComplement::solve_lower(const Factor& factor, Size size, double* x) {
  for (std::size_t i = 1; i < size; ++i) {
    const std::size_t from = first_of(factor, i, size);
    x[i] -= dot(factor.rows.data() + i * size + from, x + from, i - from, size);
  }
}

template <class Size>
void SchurComplement::solve_upper(const Factor& factor, Size size, double* x) {
  for (std::size_t i = size; i-- > 1;) {
    const std::size_t from = first_of(factor, i, size);
    add(-x[i], factor.rows.data() + i * size + from, i - from, x + from);
  }
}

bool SchurComplement::decompose(const Matrix& mass, const Matrix& gradient) {
  resize(static_cast<std::size_t>(mass.rows()), static_cast<std::size_t>(gradient.rows()));
  return with_size(n_, [&](auto n) { return decompose(mass, gradient, n); });
}

template <class Size>
bool SchurComplement::decompose(const Matrix& mass, const Matrix& gradient, Size n) {
  for (std::size_t i = 0; i < n; ++i) {
    double* const row = mass_.rows.data() + i * n;
    for (std::size_t j = 0; j <= i; ++j) row[j] = mass.data()[j * n + i];
    if (has_structure(n)) mass_.first[i] = first_nonzero(row, i);
  }
  regularity_ = pivots(mass_, n);
  return regularity_ > 0 && set_images(gradient, n) &&
         with_size(g_, [&](auto g) { return pivots(complement_, g); }) > 0;
}

/// The rows L^-1 C_b^T and their products C M^-1 C^T.
/// @return  false if two rows are nearly all one velocity's
template <class Size>
bool SchurComplement::set_images(const Matrix& gradient, Size n) {
  for (std::size_t b = 0; b < g_; ++b) {
    double* const row = rows_.data() + b * n;
    double* const image = images_.data() + b * n;
    std::size_t heaviest = 0;
    double most = 0;  // the largest square of a part of the row, in the metric of M
    double others = 0;
    for (std::size_t s = 0; s < n; ++s) {
      row[s] = image[s] = gradient.data()[s * g_ + b];
      const double square = row[s] * row[s] * mass_.inverse[s];
      if (square > most) heaviest = s;
      others += std::min(square, most);
      most = std::max(most, square);
    }
    tied_[b] = others > 0 && others < least_pivot * least_pivot * most ? heaviest : n;
    for (std::size_t a = 0; a < b; ++a) {
      if (tied_[b] < n && tied_[a] == tied_[b]) return false;
    }
    solve_lower(mass_, n, image);
    for (std::size_t s = 0; s < n; ++s) weighted_[b * n + s] = image[s] * mass_.inverse[s];
    if (has_structure(n)) set_span(b);
    for (std::size_t a = 0; a <= b; ++a) {
      const Span span = common_span(a, b, n);
      complement_.rows[b * g_ + a] =
          dot(weighted_.data() + a * n + span.begin, image + span.begin, span.end - span.begin, n);
    }
    if (has_structure(n)) complement_.first[b] = first_nonzero(complement_.rows.data() + b * g_, b);
  }
  return true;
}

/// A velocity that is nearly all of a row, as that across a skate near an axis or that of a light wheel,
/// follows from the row: as a difference of forces it would lose figures.
/// @param wanted  C x (g)
template <class Size>
void SchurComplement::tie(const Vector& wanted, Size n, double* x) const {
  for (std::size_t b = 0; b < g_; ++b) {
    const std::size_t tied = tied_[b];
    if (tied == n) continue;
    const double* const row = rows_.data() + b * n;
    x[tied] = 0;
    x[tied] = (wanted[static_cast<Index>(b)] - dot(row, x, n, n)) / row[tied];
  }
}

void SchurComplement::solve_complement(double* y) const {
  solve_lower(complement_, g_, y);
  for (std::size_t b = 0; b < g_; ++b) y[b] *= complement_.inverse[b];
  solve_upper(complement_, g_, y);
}

bool SchurComplement::solve(const Vector& h, const Vector& gamma, Vector& x, Vector& y) const {
  return with_size(n_, [&](auto n) { return solve(h, gamma, x, y, n); });
}

template <class Size>
bool SchurComplement::solve(const Vector& h, const Vector& gamma, Vector& x, Vector& y, Size n) const {
  WorkSpace<Size> work(velocities_);
  double* const force = work.data();
  double* const multipliers = multipliers_.data();
  for (std::size_t s = 0; s < n; ++s) force[s] = h.data()[s];
  solve_lower(mass_, n, force);
  for (std::size_t b = 0; b < g_; ++b) {
    const Span span = common_span(b, b, n);
    const double* const row = weighted_.data() + b * n + span.begin;
    multipliers[b] = gamma.data()[b] - dot(row, force + span.begin, span.end - span.begin, n);
  }
  solve_complement(multipliers);
  for (std::size_t b = 0; b < g_; ++b) {
    const Span span = common_span(b, b, n);
    add(multipliers[b], images_.data() + b * n + span.begin, span.end - span.begin, force + span.begin);
  }
  for (std::size_t s = 0; s < n; ++s) force[s] *= mass_.inverse[s];
  solve_upper(mass_, n, force);
  tie(gamma, n, force);
  if (!are_finite(force, n) || !are_finite(multipliers, g_)) return false;
  x.resize(static_cast<Index>(n_));
  for (std::size_t s = 0; s < n; ++s) x.data()[s] = force[s];
  y.resize(static_cast<Index>(g_));
  for (std::size_t b = 0; b < g_; ++b) y.data()[b] = multipliers[b];
  return true;
}

void SchurComplement::add_shortest(const Vector& missing, Vector& x) const {
  std::copy_n(missing.data(), g_, multipliers_.data());
  solve_complement(multipliers_.data());
  std::fill(velocities_.begin(), velocities_.end(), 0);
  for (std::size_t b = 0; b < g_; ++b) {
    add(multipliers_[b], weighted_.data() + b * n_, n_, velocities_.data());
  }
  solve_upper(mass_, n_, velocities_.data());
  tie(missing, n_, velocities_.data());
  x += Eigen::Map<const Eigen::VectorXd>(velocities_.data(), static_cast<Index>(n_));
}

// The length, in the metric of M^-1, of what is left of e_i off the rows of C.
double SchurComplement::mobility(Index i) const {
  Numbers& unit = velocities_;
  std::fill(unit.begin(), unit.end(), 0);
  unit[static_cast<std::size_t>(i)] = 1;
  solve_lower(mass_, n_, unit.data());
  for (std::size_t b = 0; b < g_; ++b) multipliers_[b] = dot(weighted_.data() + b * n_, unit.data(), n_, n_);
  solve_complement(multipliers_.data());
  for (std::size_t b = 0; b < g_; ++b) add(-multipliers_[b], images_.data() + b * n_, n_, unit.data());
  double square = 0;
  for (std::size_t s = 0; s < n_; ++s) square += unit[s] * unit[s] * mass_.inverse[s];
  return std::sqrt(square);
}

}  // namespace hybrid_sphere::mechanics
