#pragma once

#include <Eigen/Core>

#include "hybrid_sphere/sphere/twist.hpp"

namespace hybrid_sphere {

/// A rotation q' = (0, omega) q/2, q = 1 at first, over a panel of time as a polynomial: dense output of one
/// step. It is fitted to omega on Chebyshev nodes in one of two ways. A *direct* panel turns the sphere by a
/// few radians; its polynomials are those of the quaternion. A *slow* one may turn it any number of times
/// while the axis changes little. With q = (alpha, gamma), alpha = q_w + i q_z, gamma = q_x - i q_y on axes
/// whose third is that of the spin, zeta = gamma/alpha obeys
///   zeta' = conj(Omega)/2 - i omega_3 zeta + Omega zeta^2/2,   Omega = omega_1 + i omega_2,
/// which has one solution without oscillation, found by collocation without an initial value; the phase of
/// alpha is the integral of (omega_3 - Im(Omega zeta))/2. Its cost does not depend on the angle. Source:
/// docs/theory.md 6.
class RotationPanel {
 public:
  static constexpr int size = 16;
  /// omega on the nodes, a row each [rad/s].
  using Spin = Eigen::Matrix<double, size, 3>;
  using Series = Eigen::Matrix<double, size, 4>;

  /// Of how much a slow panel turns the sphere at least [rad].
  static constexpr double least_slow_angle = 60;

  /// Node i, between -1 at the beginning of the panel and 1 at its end: first those of the second half,
  /// ascending, then their opposites.
  static double node(int i);
  static constexpr int last_node = size / 2 - 1;

  /// What a fit has cost in accuracy, from the decay of the coefficients [rad], and the angle turned [rad].
  struct Fit {
    double error;
    double angle;
  };
  /// @param length  of the panel [s]
  /// @return an error of infinity where the method does not converge
  Fit fit_direct(const Spin& omega, double length);
  Fit fit_slow(const Spin& omega, double length);

  /// The turn since the beginning, a unit quaternion.
  /// @param x  as for node()
  Quaterniond at(double x) const;

 private:
  bool is_slow_ = false;
  // Powers of x. Direct: (x, y, z, w) of the quaternion. Slow: Re and Im of zeta, and the phase.
  Series series_ = Series::Zero();
  // Slow: q = frame_ (alpha, gamma) since_.
  Quaterniond frame_ = Quaterniond::Identity();
  Quaterniond since_ = Quaterniond::Identity();
};

}  // namespace hybrid_sphere
