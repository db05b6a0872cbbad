#include "motion/rotation_panel.hpp"

#include <algorithm>
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
  const auto x = w.col(0).array(), y = w.col(1).array(), z = w.col(2).array();
  const auto qx = q.col(0).array(), qy = q.col(1).array(), qz = q.col(2).array(), qw = q.col(3).array();
  Series c;
  c.col(0) = x * qw + y * qz - z * qy;
  c.col(1) = y * qw + z * qx - x * qz;
  c.col(2) = z * qw + x * qy - y * qx;
  c.col(3) = -x * qx - y * qy - z * qz;
  return c;
}

Quaterniond quaternion(const Series& q, Eigen::Index i) {
  return Quaterniond(Eigen::Vector4d(q.row(i).transpose()));
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
  const double largest = w.leftCols(terms).cwiseAbs().maxCoeff();
  while (terms > 1 && w.col(terms - 1).cwiseAbs().maxCoeff() <= hidden * largest) --terms;
  return terms;
}

/// What all powers leave out, those beyond `terms` being 0.
double left_out_of(const polynomials::Powers<3>& omega, int terms) {
  constexpr int looked_at = 4;
  if (terms <= size - looked_at) return 0;
  polynomials::Powers<3> all = polynomials::Powers<3>::Zero();
  all.leftCols(terms) = omega.leftCols(terms);
  return polynomials::left_out<3>(all, 0, 3);
}

}  // namespace

double RotationPanel::node(int i) { return chebyshev::maps().nodes[i]; }

// In a frame that turns by the mean of omega, what remains is a small turn s' = (0, rest) s/2, s = 1 in the
// middle: Picard's iteration converges like the powers of its angle over factorials.
RotationPanel::Fit RotationPanel::fit_direct(const Spin& omega, double length, const Quaterniond& start) {
  constexpr int max_iterations = 40;
  const chebyshev::Maps& maps = chebyshev::maps();
  const Vector3d mean = omega.transpose().lazyProduct(maps.weights);
  const double rate = mean.norm();
  const Vector3d axis = rate > 0 ? Vector3d(mean / rate) : Vector3d(0, 0, 1);
  Eigen::Matrix<double, 4, size> turned;  // by the mean
  Spin rest;
  for (Eigen::Index i = 0; i < half; ++i) {
    const double half_angle = 0.25 * length * rate * maps.nodes[i];
    const Vector3d sine = std::sin(half_angle) * axis;
    const double cosine = std::cos(half_angle);
    turned.col(i) << sine, cosine;
    turned.col(half + i) << -sine, cosine;
  }
  for (Eigen::Index i = 0; i < size; ++i) {
    const Vector3d excess = 0.25 * length * (omega.row(i).transpose() - mean);
    rest.row(i) = (Quaterniond(turned.col(i)).conjugate() * excess).transpose();
  }
  Series small = Series::Zero();
  small.col(3).setOnes();
  double last = inf;
  for (int k = 0;; ++k) {
    Series next = integral_of(product(rest, small));
    next.col(3).array() += 1;
    const double change = (next - small).lpNorm<Eigen::Infinity>();
    small = next;
    if (change <= 0x1p-54 || (change <= 0x1p-48 && change >= last)) break;
    if (k == max_iterations || !(change < 1e3)) return {inf, 0, 0};
    last = change;
  }
  Series q;
  for (Eigen::Index i = 0; i < size; ++i)
    q.row(i) = (Quaterniond(turned.col(i)) * quaternion(small, i)).coeffs().transpose();
  const Parts c = coefficients_of(q);
  series_ = powers_of(c).transpose();
  is_slow_ = false;
  start_at(start);
  // What the nodes do not show of the small turn's rate is an error of all of q.
  Series drive = Series::Zero();
  drive.leftCols<3>() = rest;
  const double unseen = left_out(coefficients_of(drive), 0, 3) / (size * size);
  return {4 * (left_out(c, 0, 4) + 2 * unseen), length * maps.weights.dot(omega.rowwise().norm()),
          omega.row(last_node).norm()};
}

RotationPanel::Fit RotationPanel::expand(const polynomials::Powers<3>& omega, int terms, double length,
                                         const Quaterniond& start) {
  polynomials::Powers<3> w;
  w.leftCols(terms) = (0.25 * length) * omega.leftCols(terms);
  polynomials::LongPowers taylor;
  taylor.col(0) = Quaterniond::Identity().coeffs();
  const bool turns_little = w.leftCols(terms).cwiseAbs().maxCoeff() < 0.25;
  const int count = turns_little ? size + 2 : polynomials::long_size;
  polynomials::follow(w, seen_terms(w, terms), count, taylor);
  const double truncated = taylor.middleCols<2>(count - 2).cwiseAbs().maxCoeff();
  const double left_out = polynomials::economize(taylor, series_) + truncated;
  const double unseen = 0.25 * length * left_out_of(omega, terms) / size;
  const double error = 8 * (left_out + 2 * unseen);
  is_slow_ = false;
  start_at(start);
  Vector3d first = Vector3d::Zero();
  Vector3d last = Vector3d::Zero();
  for (int k = terms - 1; k >= 0; --k) {
    first = omega.col(k) - node(last_node) * first;
    last = omega.col(k) + node(last_node) * last;
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
