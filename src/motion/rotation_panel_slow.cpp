#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <optional>

#include "motion/chebyshev.hpp"
#include "motion/collocation_lu.hpp"
#include "motion/phi.hpp"
#include "motion/rotation_panel.hpp"

namespace hybrid_sphere {
namespace {

constexpr std::size_t nodes = chebyshev::size;
using RealColumn = std::array<double, nodes>;
using ComplexColumn = CollocationLu::Column;

/// The derivative of a function, from its values on the nodes.
ComplexColumn derivative_of(const ComplexColumn& values) {
  const double* const matrix = chebyshev::maps().derivative.data();
  ComplexColumn derivative{};
  for (std::size_t k = 0; k < nodes; ++k) {
    for (std::size_t i = 0; i < nodes; ++i) derivative[i] += matrix[k * nodes + i] * values[k];
  }
  return derivative;
}

double largest_of(const ComplexColumn& values) {
  double largest = 0;
  for (const Complex& value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

/// zeta on the nodes, with omega times half the length; empty where Newton's method does not converge.
std::optional<ComplexColumn> slow_solution(const RealColumn& third, const ComplexColumn& planar) {
  constexpr int max_iterations = 30;
  if (!std::all_of(third.begin(), third.end(), [](double x) { return x > 0; })) return std::nullopt;
  const chebyshev::Maps& maps = chebyshev::maps();
  ComplexColumn zeta;
  CollocationLu::Square matrix;
  for (std::size_t k = 0; k < nodes; ++k) {
    zeta[k] = 0.5 * (std::conj(planar[k]) / Complex(0, third[k]));
    for (std::size_t i = 0; i < nodes; ++i) matrix[k][i] = maps.derivative.data()[k * nodes + i];
    matrix[k][k] += Complex(0, third[k]) - times(planar[k], zeta[k]);
  }
  const CollocationLu solver(matrix);
  double last = std::numeric_limits<double>::infinity();
  for (int k = 0;; ++k) {
    ComplexColumn left = derivative_of(zeta);
    for (std::size_t i = 0; i < nodes; ++i) {
      const Complex bend = times(times(planar[i], zeta[i]), zeta[i]);
      left[i] = left[i] + times(Complex(0, third[i]), zeta[i]) - 0.5 * std::conj(planar[i]) - 0.5 * bend;
    }
    const ComplexColumn correction = solver.solve(left);
    for (std::size_t i = 0; i < nodes; ++i) zeta[i] -= correction[i];
    const double change = largest_of(correction);
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

double size_of(const Vector3d& v) { return std::sqrt(v.x() * v.x() + (v.y() * v.y() + v.z() * v.z())); }

}  // namespace

RotationPanel::Fit RotationPanel::fit_slow(const Spin& omega, double length, const Quaterniond& start) {
  const Quaterniond frame = turn_of_third_axis_to(mean_of(omega)).normalized();
  const Eigen::Matrix3d axes = frame.toRotationMatrix();
  RealColumn third;
  ComplexColumn planar;
  for (std::size_t i = 0; i < nodes; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const Vector3d spin(omega(row, 0), omega(row, 1), omega(row, 2));
    Vector3d local;
    for (int k = 0; k < 3; ++k) {
      local[k] = spin.x() * axes(0, k) + spin.y() * axes(1, k) + spin.z() * axes(2, k);
    }
    // The rounding of the frame must not change the rate: it would add up over the angle.
    local *= size_of(spin) / size_of(local);
    third[i] = (0.5 * length) * local.z();
    planar[i] = {(0.5 * length) * local.x(), (0.5 * length) * local.y()};
  }
  const std::optional<ComplexColumn> solution = slow_solution(third, planar);
  if (!solution) return {std::numeric_limits<double>::infinity(), 0, 0};
  chebyshev::Table<4> values = chebyshev::Table<4>::Zero();
  for (std::size_t i = 0; i < nodes; ++i) {
    const Complex& zeta = (*solution)[i];
    const auto row = static_cast<Eigen::Index>(i);
    values(row, 0) = zeta.real();
    values(row, 1) = zeta.imag();
    values(row, 2) = 0.5 * (third[i] - times(planar[i], zeta).imag());
  }
  const chebyshev::Parts<4> of_values = chebyshev::coefficients_of(values);
  // The rate of the phase first: an integral of its series is better than a series of its integral.
  chebyshev::Parts<4> c = of_values;
  for (Eigen::Index n = 0; n < chebyshev::half; ++n) {
    const auto degree = 2 * static_cast<double>(n);
    const double next = n + 1 < chebyshev::half ? of_values.even(n + 1, 2) : 0;
    c.odd(n, 2) = ((n == 0 ? 2 : 1) * of_values.even(n, 2) - next) / (2 * (degree + 1));
    c.even(n, 2) = n > 0 ? (of_values.odd(n - 1, 2) - of_values.odd(n, 2)) / (2 * degree) : 0;
  }
  series_ = chebyshev::powers_of(c);
  is_slow_ = true;
  frame_ = frame;
  since_ = Quaterniond::Identity();
  start_at(start);
  return {2 * (chebyshev::left_out(of_values, 0, 2) + chebyshev::left_out(of_values, 2, 1) / size),
          length * mean_size_of(omega), size_at(omega, last_node)};
}

Quaterniond RotationPanel::slow(const Eigen::Vector4d& value) const {
  const double size_of_alpha = 1 / std::sqrt(1 + (value[0] * value[0] + value[1] * value[1]));
  const std::complex<double> alpha(size_of_alpha * std::cos(value[2]), size_of_alpha * std::sin(value[2]));
  const double re = value[0] * alpha.real() - value[1] * alpha.imag();
  const double im = value[0] * alpha.imag() + value[1] * alpha.real();
  return frame_ * Quaterniond(alpha.real(), re, -im, alpha.imag()) * since_;
}

}  // namespace hybrid_sphere
