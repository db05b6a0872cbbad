#include "motion/rotation_panel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "motion/chebyshev.hpp"

namespace hybrid_sphere {
namespace {

constexpr int size = RotationPanel::size;
constexpr int half = size / 2;
constexpr double inf = std::numeric_limits<double>::infinity();
using chebyshev::coefficients_of;
using chebyshev::integral_of;
using chebyshev::left_out;
using chebyshev::powers_of;
using Series = chebyshev::Table<4>;
using Parts = chebyshev::Parts<4>;

/// (0, w) q, node by node, with quaternions as columns x, y, z, w.
Series product(const RotationPanel::Spin& w, const Series& q) {
  Series c;
  for (int i = 0; i < size; ++i) {
    const double x = w(i, 0), y = w(i, 1), z = w(i, 2);
    const double qx = q(i, 0), qy = q(i, 1), qz = q(i, 2), qw = q(i, 3);
    c(i, 0) = x * qw + y * qz - z * qy;
    c(i, 1) = y * qw + z * qx - x * qz;
    c(i, 2) = z * qw + x * qy - y * qx;
    c(i, 3) = -x * qx - y * qy - z * qz;
  }
  return c;
}

/// The largest component of `count` columns.
template <class Columns>
double largest_of(const Columns& columns, int first, int count) {
  constexpr int rows = Columns::RowsAtCompileTime;
  const double* const numbers = columns.data() + first * rows;
  double largest = std::abs(numbers[0]);
  for (int i = 1; i < count * rows; ++i) largest = std::max(largest, std::abs(numbers[i]));
  return largest;
}

/// The matrix of q -> q p on (x, y, z, w).
Eigen::Matrix4d product_with(const Quaterniond& p) {
  Eigen::Matrix4d matrix;
  matrix << p.w(), p.z(), -p.y(), p.x(),  //
      -p.z(), p.w(), p.x(), p.y(),        //
      p.y(), -p.x(), p.w(), p.z(),        //
      -p.x(), -p.y(), -p.z(), p.w();
  return matrix;
}

/// How many of these powers the rounding of all does not hide.
int seen_terms(const polynomials::Powers<3>& w, int terms) {
  constexpr double hidden = 0x1p-58;
  const double largest = largest_of(w, 0, terms);
  while (terms > 1 && largest_of(w, terms - 1, 1) <= hidden * largest) --terms;
  return terms;
}

/// What all powers leave out, those beyond `terms` being 0.
double left_out_of(const polynomials::Powers<3>& omega, int terms) {
  constexpr int looked_at = 4;
  if (terms <= size - looked_at) return 0;
  polynomials::Powers<3> all = polynomials::Powers<3>::Zero();
  for (int k = 0; k < terms; ++k) all.col(k) = omega.col(k);
  return polynomials::left_out<3>(all, 0, 3);
}

}  // namespace

Vector3d RotationPanel::mean_of(const Spin& omega) {
  Vector3d mean;
  for (Eigen::Index k = 0; k < 3; ++k) mean[k] = chebyshev::mean_of(omega.data() + k * size);
  return mean;
}

/// Adds four products at a time, as vector instructions do.
double RotationPanel::mean_size_of(const Spin& omega) {
  const chebyshev::Column& weights = chebyshev::maps().weights;
  double sums[4] = {};
  for (int i = 0; i < size; ++i) sums[i % 4] += weights[i] * size_at(omega, i);
  return (sums[0] + sums[2]) + (sums[1] + sums[3]);
}

double RotationPanel::size_at(const Spin& omega, int i) {
  return std::sqrt(omega(i, 0) * omega(i, 0) + (omega(i, 1) * omega(i, 1) + omega(i, 2) * omega(i, 2)));
}

double RotationPanel::node(int i) { return chebyshev::maps().nodes[i]; }

// In a frame that turns by the mean of omega, what remains is a small turn s' = (0, rest) s/2, s = 1 in the
// middle: Picard's iteration converges like the powers of its angle over factorials.
RotationPanel::Fit RotationPanel::fit_direct(const Spin& omega, double length, const Quaterniond& start) {
  constexpr int max_iterations = 40;
  const Vector3d mean = mean_of(omega);
  const double rate = mean.norm();
  const Vector3d axis = rate > 0 ? Vector3d(mean / rate) : Vector3d(0, 0, 1);
  std::array<Quaterniond, size> turned;  // by the mean
  Spin rest;
  for (int i = 0; i < size; ++i) {
    // The nodes of the second half are the opposites of those of the first one.
    const double half_angle = 0.25 * length * rate * node(i % half);
    const Vector3d sine = (i < half ? 1 : -1) * (std::sin(half_angle) * axis);
    turned[std::size_t(i)] = Quaterniond(std::cos(half_angle), sine.x(), sine.y(), sine.z());
    const Vector3d excess = 0.25 * length * (Vector3d(omega(i, 0), omega(i, 1), omega(i, 2)) - mean);
    const Vector3d turned_excess = turned[std::size_t(i)].conjugate() * excess;
    for (int k = 0; k < 3; ++k) rest(i, k) = turned_excess[k];
  }
  Series small = Series::Zero();
  for (int i = 0; i < size; ++i) small(i, 3) = 1;
  double last = inf;
  for (int k = 0;; ++k) {
    Series next = integral_of(product(rest, small));
    for (int i = 0; i < size; ++i) next(i, 3) += 1;
    const double change = (next - small).lpNorm<Eigen::Infinity>();
    small = next;
    if (change <= 0x1p-54 || (change <= 0x1p-48 && change >= last)) break;
    if (k == max_iterations || !(change < 1e3)) return {inf, 0, 0};
    last = change;
  }
  Series q;
  for (int i = 0; i < size; ++i) {
    const Quaterniond turn =
        turned[std::size_t(i)] * Quaterniond(small(i, 3), small(i, 0), small(i, 1), small(i, 2));
    for (int k = 0; k < 4; ++k) q(i, k) = turn.coeffs()[k];
  }
  const Parts c = coefficients_of(q);
  series_ = powers_of(c);
  is_slow_ = false;
  start_at(start);
  // What the nodes do not show of the small turn's rate is an error of all of q.
  const double unseen = left_out(coefficients_of(rest), 0, 3) / (size * size);
  return {4 * (left_out(c, 0, 4) + 2 * unseen), length * mean_size_of(omega), size_at(omega, last_node)};
}

RotationPanel::Fit RotationPanel::expand(const polynomials::Powers<3>& omega, int terms, double length,
                                         const Quaterniond& start) {
  polynomials::Powers<3> w = polynomials::Powers<3>::Zero();
  for (int i = 0; i < 3 * terms; ++i) w.data()[i] = (0.25 * length) * omega.data()[i];
  polynomials::LongPowers taylor;
  taylor.col(0) = Quaterniond::Identity().coeffs();
  const bool turns_little = largest_of(w, 0, terms) < 0.25;
  const int count = turns_little ? size + 2 : polynomials::long_size;
  polynomials::follow(w, seen_terms(w, terms), count, taylor);
  const double truncated = largest_of(taylor, count - 2, 2);
  const double left_out = polynomials::economize(taylor, series_) + truncated;
  const double unseen = 0.25 * length * left_out_of(omega, terms) / size;
  const double error = 8 * (left_out + 2 * unseen);
  is_slow_ = false;
  start_at(start);
  Vector3d first = Vector3d::Zero();
  Vector3d last = Vector3d::Zero();
  for (int k = terms - 1; k >= 0; --k) {
    const Vector3d power = omega.col(k);
    first = power - node(last_node) * first;
    last = power + node(last_node) * last;
  }
  const double rate = last.norm();
  const double angle = length / 6 * (first.norm() + 4 * omega.col(0).norm() + rate);
  if (!std::isfinite(error) || !std::isfinite(angle)) return {inf, 0, 0};
  return {error, angle, rate, true};
}

/// Turns what has been fitted so that it begins there.
void RotationPanel::start_at(const Quaterniond& start) {
  const Quaterniond turn = at(-1).conjugate() * start;
  if (is_slow_) {
    since_ = turn;
  } else {
    polynomials::multiply(product_with(turn), series_);
  }
}

}  // namespace hybrid_sphere
