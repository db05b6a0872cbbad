#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <optional>

#include "motion/chebyshev.hpp"
#include "motion/collocation_lu.hpp"
#include "motion/rotation_panel.hpp"

namespace hybrid_sphere {
namespace {

using chebyshev::Column;
using ComplexColumn = CollocationLu::Column;

/// zeta on the nodes, with omega times half the length; empty where Newton's method does not converge.
std::optional<ComplexColumn> slow_solution(const Column& third, const ComplexColumn& planar) {
  constexpr int max_iterations = 30;
  constexpr std::complex<double> i(0, 1);
  if (!(third.minCoeff() > 0)) return std::nullopt;
  const chebyshev::Maps& maps = chebyshev::maps();
  const ComplexColumn turn = i * third;
  ComplexColumn zeta = 0.5 * planar.conjugate().cwiseQuotient(turn);
  CollocationLu::Square matrix = maps.derivative.cast<std::complex<double>>();
  matrix.diagonal() += turn - planar.cwiseProduct(zeta);
  const CollocationLu solver(matrix);
  double last = std::numeric_limits<double>::infinity();
  for (int k = 0;; ++k) {
    const ComplexColumn left = maps.derivative * zeta + turn.cwiseProduct(zeta) - 0.5 * planar.conjugate() -
                               0.5 * planar.cwiseProduct(zeta).cwiseProduct(zeta);
    const ComplexColumn correction = solver.solve(left);
    zeta -= correction;
    const double change = correction.lpNorm<Eigen::Infinity>();
    if (change <= 0x1p-54 || (change <= 0x1p-44 && change >= last)) return zeta;
    if (k == max_iterations || !(change < 1)) return std::nullopt;
    last = change;
  }
}

/// Returns a rotation R with R e_3 = direction/|direction|, about the axis that is perpendicular to both. It
/// equals Quaterniond::FromTwoVectors, which decomposes a matrix for a direction close to -e_3.
Quaterniond turn_of_third_axis_to(const Vector3d& direction) {
  constexpr double max_cosine_of_opposite = -1 + 1e-12;  // the sum 1 + cosine loses all its digits below
  const Vector3d third = Vector3d::UnitZ();
  const Vector3d unit = direction.normalized();
  const double cosine = unit.dot(third);
  const Vector3d axis = third.cross(unit);
  Quaterniond turn;
  if (cosine < max_cosine_of_opposite) {
    const double half_cosine_squared = 0.5 * (1 + std::max(cosine, -1.0));
    const double length = axis.norm();
    turn.w() = std::sqrt(half_cosine_squared);
    // At a right angle to e_3 up to round-off, any axis turns e_3 to -e_3.
    turn.vec() =
        (length > std::numeric_limits<double>::epsilon() ? Vector3d(axis / length) : Vector3d(-1, 0, 0)) *
        std::sqrt(1 - half_cosine_squared);
  } else {
    const double twice_half_cosine = std::sqrt((1 + cosine) * 2);
    turn.vec() = axis * (1 / twice_half_cosine);
    turn.w() = 0.5 * twice_half_cosine;
  }
  return turn;
}

}  // namespace

RotationPanel::Fit RotationPanel::fit_slow(const Spin& omega, double length, const Quaterniond& start) {
  const chebyshev::Maps& maps = chebyshev::maps();
  const Vector3d mean = omega.transpose() * maps.weights;
  const Quaterniond frame = turn_of_third_axis_to(mean).normalized();
  Spin local = omega * frame.toRotationMatrix();
  // The rounding of the frame must not change the rate: it would add up over the angle.
  local.array().colwise() *= omega.rowwise().norm().array() / local.rowwise().norm().array();
  const Column third = (0.5 * length) * local.col(2);
  ComplexColumn planar;
  planar.real() = (0.5 * length) * local.col(0);
  planar.imag() = (0.5 * length) * local.col(1);
  const std::optional<ComplexColumn> solution = slow_solution(third, planar);
  if (!solution) return {std::numeric_limits<double>::infinity(), 0, 0};
  const ComplexColumn& zeta = *solution;
  chebyshev::Table<4> values = chebyshev::Table<4>::Zero();
  values.col(0) = zeta.real();
  values.col(1) = zeta.imag();
  const chebyshev::Parts<4> of_zeta = chebyshev::coefficients_of(values);
  // The rate of the phase first: an integral of its series is better than a series of its integral.
  values.setZero();
  values.col(0) = 0.5 * (third - planar.cwiseProduct(zeta).imag());
  const chebyshev::Parts<4> of_rate = chebyshev::coefficients_of(values);
  chebyshev::Parts<4> c = of_zeta;
  for (Eigen::Index n = 0; n < chebyshev::half; ++n) {
    const auto degree = 2 * static_cast<double>(n);
    const double next = n + 1 < chebyshev::half ? of_rate.even(n + 1, 0) : 0;
    c.odd(n, 2) = ((n == 0 ? 2 : 1) * of_rate.even(n, 0) - next) / (2 * (degree + 1));
    if (n > 0) c.even(n, 2) = (of_rate.odd(n - 1, 0) - of_rate.odd(n, 0)) / (2 * degree);
  }
  series_ = chebyshev::powers_of(c).transpose();
  is_slow_ = true;
  frame_ = frame;
  since_ = Quaterniond::Identity();
  start_at(start);
  return {2 * (chebyshev::left_out(of_zeta, 0, 2) + chebyshev::left_out(of_rate, 0, 1) / size),
          length * maps.weights.dot(omega.rowwise().norm()), omega.row(last_node).norm()};
}

Quaterniond RotationPanel::slow(const Eigen::Vector4d& value) const {
  const double size_of_alpha = 1 / std::sqrt(1 + value.head<2>().squaredNorm());
  const std::complex<double> alpha(size_of_alpha * std::cos(value[2]), size_of_alpha * std::sin(value[2]));
  const double re = value[0] * alpha.real() - value[1] * alpha.imag();
  const double im = value[0] * alpha.imag() + value[1] * alpha.real();
  return frame_ * Quaterniond(alpha.real(), re, -im, alpha.imag()) * since_;
}

}  // namespace hybrid_sphere
