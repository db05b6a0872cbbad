#include "mechanics/schur_complement.hpp"

#include <algorithm>
#include <cmath>

namespace hybrid_sphere::mechanics {
namespace {

// Pivots below this part of the diagonal are left to SaddlePoint.
constexpr double least_pivot = 1.0 / 64;

// Beyond, squares leave the range of numbers.
constexpr double smallest = 1e-120;
constexpr double largest = 1e120;

bool is_in_range(double x) { return x > smallest && x < largest; }

double dot(const std::array<double, SchurComplement::max_size>& a,
           const std::array<double, SchurComplement::max_size>& b, std::size_t size) {
  double sum = 0;
  for (std::size_t i = 0; i < size; ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace

/// Decomposes the lower triangle in `factor` in place.
/// @return  the smallest pivot relative to the diagonal; 0 if it is too small
double SchurComplement::pivots(Factor& factor, std::size_t size) {
  double least = 1;
  for (std::size_t i = 0; i < size; ++i) {
    Numbers& row = factor.rows[i];
    for (std::size_t j = 0; j < i; ++j) {
      row[j] = (row[j] - dot(row, factor.rows[j], j)) * factor.inverse[j];
    }
    const double diagonal = row[i];
    const double pivot = diagonal - dot(row, row, i);
    if (!is_in_range(diagonal) || !(pivot > least_pivot * diagonal)) return 0;
    least = std::min(least, pivot / diagonal);
    row[i] = std::sqrt(pivot);
    factor.inverse[i] = 1 / row[i];
  }
  return least;
}

void SchurComplement::solve_lower(const Factor& factor, std::size_t size, Numbers& x) {
  for (std::size_t i = 0; i < size; ++i) x[i] = (x[i] - dot(factor.rows[i], x, i)) * factor.inverse[i];
}

void SchurComplement::solve_upper(const Factor& factor, std::size_t size, Numbers& x) {
  for (std::size_t i = size; i-- > 0;) {
    x[i] *= factor.inverse[i];
    for (std::size_t j = 0; j < i; ++j) x[j] -= factor.rows[i][j] * x[i];
  }
}

bool SchurComplement::decompose(const Matrix& mass, const Matrix& gradient) {
  if (mass.rows() > max_size || gradient.rows() > max_size) return false;
  n_ = static_cast<std::size_t>(mass.rows());
  g_ = static_cast<std::size_t>(gradient.rows());
  for (std::size_t i = 0; i < n_; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      mass_.rows[i][j] = mass(static_cast<Index>(i), static_cast<Index>(j));
    }
  }
  regularity_ = pivots(mass_, n_);
  return regularity_ > 0 && set_images(gradient) && pivots(complement_, g_) > 0;
}

/// The rows L^-1 C_b^T and their products C M^-1 C^T.
/// @return  false if two rows are nearly all one velocity's
bool SchurComplement::set_images(const Matrix& gradient) {
  for (std::size_t b = 0; b < g_; ++b) {
    Numbers& image = images_[b];
    std::size_t heaviest = 0;
    double most = 0;
    double sum = 0;
    for (std::size_t s = 0; s < n_; ++s) {
      image[s] = gradient(static_cast<Index>(b), static_cast<Index>(s));
      const double part = std::abs(image[s] * mass_.inverse[s]);
      if (part > most) heaviest = s;
      most = std::max(most, part);
      sum += part;
    }
    rows_[b] = image;
    const double others = sum - most;
    tied_[b] = others > 0 && others < least_pivot * most ? heaviest : max_size;
    for (std::size_t a = 0; a < b; ++a) {
      if (tied_[b] < max_size && tied_[a] == tied_[b]) return false;
    }
    solve_lower(mass_, n_, image);
    for (std::size_t a = 0; a <= b; ++a) complement_.rows[b][a] = dot(images_[a], image, n_);
  }
  return true;
}

/// A velocity that is nearly all of a row, as that across a skate near an axis or that of a light wheel,
/// follows from the row: as a difference of forces it would lose figures.
/// @param wanted  C x (g)
void SchurComplement::tie(const Vector& wanted, Numbers& x) const {
  for (std::size_t b = 0; b < g_; ++b) {
    const std::size_t tied = tied_[b];
    if (tied == max_size) continue;
    x[tied] = 0;
    x[tied] = (wanted[static_cast<Index>(b)] - dot(rows_[b], x, n_)) / rows_[b][tied];
  }
}

void SchurComplement::solve_complement(Numbers& y) const {
  solve_lower(complement_, g_, y);
  solve_upper(complement_, g_, y);
}

bool SchurComplement::solve(const Vector& h, const Vector& gamma, Vector& x, Vector& y) const {
  Numbers force;
  Numbers multipliers;
  for (std::size_t s = 0; s < n_; ++s) force[s] = h[static_cast<Index>(s)];
  solve_lower(mass_, n_, force);
  for (std::size_t b = 0; b < g_; ++b) {
    multipliers[b] = gamma[static_cast<Index>(b)] - dot(images_[b], force, n_);
  }
  solve_complement(multipliers);
  for (std::size_t b = 0; b < g_; ++b) {
    for (std::size_t s = 0; s < n_; ++s) force[s] += images_[b][s] * multipliers[b];
  }
  solve_upper(mass_, n_, force);
  tie(gamma, force);
  const auto is_finite = [](double number) { return std::isfinite(number); };
  if (!std::all_of(force.begin(), force.begin() + n_, is_finite)) return false;
  if (!std::all_of(multipliers.begin(), multipliers.begin() + g_, is_finite)) return false;
  x = Eigen::Map<const Eigen::VectorXd>(force.data(), static_cast<Index>(n_));
  y = Eigen::Map<const Eigen::VectorXd>(multipliers.data(), static_cast<Index>(g_));
  return true;
}

void SchurComplement::add_shortest(const Vector& missing, Vector& x) const {
  Numbers multipliers;
  for (std::size_t b = 0; b < g_; ++b) multipliers[b] = missing[static_cast<Index>(b)];
  solve_complement(multipliers);
  Numbers change{};
  for (std::size_t b = 0; b < g_; ++b) {
    for (std::size_t s = 0; s < n_; ++s) change[s] += images_[b][s] * multipliers[b];
  }
  solve_upper(mass_, n_, change);
  tie(missing, change);
  x += Eigen::Map<const Eigen::VectorXd>(change.data(), static_cast<Index>(n_));
}

// The length of what is left of L^-1 e_i off the images.
double SchurComplement::mobility(Index i) const {
  Numbers unit{};
  unit[static_cast<std::size_t>(i)] = 1;
  solve_lower(mass_, n_, unit);
  Numbers parts;
  for (std::size_t b = 0; b < g_; ++b) parts[b] = dot(images_[b], unit, n_);
  solve_complement(parts);
  for (std::size_t b = 0; b < g_; ++b) {
    for (std::size_t s = 0; s < n_; ++s) unit[s] -= images_[b][s] * parts[b];
  }
  return std::sqrt(dot(unit, unit, n_));
}

}  // namespace hybrid_sphere::mechanics
