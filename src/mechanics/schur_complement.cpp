#include "mechanics/schur_complement.hpp"

#include <algorithm>
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

using Numbers = std::array<double, SchurComplement::max_size>;

template <class Size>
double dot(const Numbers& a, const Numbers& b, Size size) {
  double sum = 0;
  for (std::size_t i = 0; i < size; ++i) sum += a[i] * b[i];
  return sum;
}

/// x += factor y
template <class Size>
void add(double factor, const Numbers& y, Size size, Numbers& x) {
  for (std::size_t i = 0; i < size; ++i) x[i] += factor * y[i];
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

void read(const Vector& vector, Numbers& numbers) {
  std::copy(vector.data(), vector.data() + vector.size(), numbers.begin());
}

bool are_finite(const Numbers& numbers, std::size_t size) {
  return std::all_of(numbers.begin(), numbers.begin() + size, [](double x) { return std::isfinite(x); });
}

}  // namespace

/// Decomposes the lower triangle in `factor` in place.
/// @return  the smallest pivot relative to the diagonal; 0 if it is too small
template <class Size>
double SchurComplement::pivots(Factor& factor, Size size) {
  double least = 1;
  for (std::size_t i = 0; i < size; ++i) {
    Numbers& row = factor.rows[i];
    const double diagonal = row[i];
    double pivot = diagonal;
    for (std::size_t j = 0; j < i; ++j) row[j] -= dot(row, factor.rows[j], j);  // of L D
    for (std::size_t j = 0; j < i; ++j) {
      const double of_ld = row[j];
      row[j] *= factor.inverse[j];
      pivot -= of_ld * row[j];
    }
    if (!is_in_range(diagonal) || !(pivot > least_pivot * diagonal)) return 0;
    factor.inverse[i] = 1 / pivot;
    least = std::min(least, pivot / diagonal);
  }
  return least;
}

template <class Size>
void SchurComplement::solve_lower(const Factor& factor, Size size, Numbers& x) {
  for (std::size_t i = 1; i < size; ++i) x[i] -= dot(factor.rows[i], x, i);
}

template <class Size>
void SchurComplement::solve_upper(const Factor& factor, Size size, Numbers& x) {
  for (std::size_t i = size; i-- > 1;) add(-x[i], factor.rows[i], i, x);
}

bool SchurComplement::decompose(const Matrix& mass, const Matrix& gradient) {
  if (mass.rows() > max_size || gradient.rows() > max_size) return false;
  n_ = static_cast<std::size_t>(mass.rows());
  g_ = static_cast<std::size_t>(gradient.rows());
  return with_size(n_, [&](auto n) { return decompose(mass, gradient, n); });
}

template <class Size>
bool SchurComplement::decompose(const Matrix& mass, const Matrix& gradient, Size n) {
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) mass_.rows[i][j] = mass.data()[j * n + i];
  }
  regularity_ = pivots(mass_, n);
  return regularity_ > 0 && set_images(gradient, n) && pivots(complement_, g_) > 0;
}

/// The rows L^-1 C_b^T and their products C M^-1 C^T.
/// @return  false if two rows are nearly all one velocity's
template <class Size>
bool SchurComplement::set_images(const Matrix& gradient, Size n) {
  for (std::size_t b = 0; b < g_; ++b) {
    Numbers& row = rows_[b];
    std::size_t heaviest = 0;
    double most = 0;  // the largest square of a part of the row, in the metric of M
    double others = 0;
    for (std::size_t s = 0; s < n; ++s) {
      row[s] = gradient.data()[s * g_ + b];
      const double square = row[s] * row[s] * mass_.inverse[s];
      if (square > most) heaviest = s;
      others += std::min(square, most);
      most = std::max(most, square);
    }
    tied_[b] = others > 0 && others < least_pivot * least_pivot * most ? heaviest : max_size;
    for (std::size_t a = 0; a < b; ++a) {
      if (tied_[b] < max_size && tied_[a] == tied_[b]) return false;
    }
    images_[b] = row;
    solve_lower(mass_, n, images_[b]);
    for (std::size_t s = 0; s < n; ++s) weighted_[b][s] = images_[b][s] * mass_.inverse[s];
    for (std::size_t a = 0; a <= b; ++a) complement_.rows[b][a] = dot(weighted_[a], images_[b], n);
  }
  return true;
}

/// A velocity that is nearly all of a row, as that across a skate near an axis or that of a light wheel,
/// follows from the row: as a difference of forces it would lose figures.
/// @param wanted  C x (g)
template <class Size>
void SchurComplement::tie(const Vector& wanted, Size n, Numbers& x) const {
  for (std::size_t b = 0; b < g_; ++b) {
    const std::size_t tied = tied_[b];
    if (tied == max_size) continue;
    x[tied] = 0;
    x[tied] = (wanted[static_cast<Index>(b)] - dot(rows_[b], x, n)) / rows_[b][tied];
  }
}

void SchurComplement::solve_complement(Numbers& y) const {
  solve_lower(complement_, g_, y);
  for (std::size_t b = 0; b < g_; ++b) y[b] *= complement_.inverse[b];
  solve_upper(complement_, g_, y);
}

bool SchurComplement::solve(const Vector& h, const Vector& gamma, Vector& x, Vector& y) const {
  return with_size(n_, [&](auto n) { return solve(h, gamma, x, y, n); });
}

template <class Size>
bool SchurComplement::solve(const Vector& h, const Vector& gamma, Vector& x, Vector& y, Size n) const {
  Numbers force;
  Numbers multipliers;
  read(h, force);
  read(gamma, multipliers);
  solve_lower(mass_, n, force);
  for (std::size_t b = 0; b < g_; ++b) multipliers[b] -= dot(weighted_[b], force, n);
  solve_complement(multipliers);
  for (std::size_t b = 0; b < g_; ++b) add(multipliers[b], images_[b], n, force);
  for (std::size_t s = 0; s < n; ++s) force[s] *= mass_.inverse[s];
  solve_upper(mass_, n, force);
  tie(gamma, n, force);
  if (!are_finite(force, n) || !are_finite(multipliers, g_)) return false;
  x = Eigen::Map<const Eigen::VectorXd>(force.data(), static_cast<Index>(n_));
  y = Eigen::Map<const Eigen::VectorXd>(multipliers.data(), static_cast<Index>(g_));
  return true;
}

void SchurComplement::add_shortest(const Vector& missing, Vector& x) const {
  Numbers multipliers;
  read(missing, multipliers);
  solve_complement(multipliers);
  Numbers change{};
  for (std::size_t b = 0; b < g_; ++b) add(multipliers[b], weighted_[b], n_, change);
  solve_upper(mass_, n_, change);
  tie(missing, n_, change);
  x += Eigen::Map<const Eigen::VectorXd>(change.data(), static_cast<Index>(n_));
}

// The length, in the metric of M^-1, of what is left of e_i off the rows of C.
double SchurComplement::mobility(Index i) const {
  Numbers unit{};
  unit[static_cast<std::size_t>(i)] = 1;
  solve_lower(mass_, n_, unit);
  Numbers parts;
  for (std::size_t b = 0; b < g_; ++b) parts[b] = dot(weighted_[b], unit, n_);
  solve_complement(parts);
  for (std::size_t b = 0; b < g_; ++b) add(-parts[b], images_[b], n_, unit);
  double square = 0;
  for (std::size_t s = 0; s < n_; ++s) square += unit[s] * unit[s] * mass_.inverse[s];
  return std::sqrt(square);
}

}  // namespace hybrid_sphere::mechanics
