#pragma once

#include <Eigen/Core>

#include "geometry/vectors.hpp"
#include "hybrid_sphere/sphere/twist.hpp"
#include "motion/polynomials.hpp"
#include "sphere/unit_quaternion.hpp"

namespace hybrid_sphere {

/// A rotation q' = (0, omega) q/2 over a panel of time as a polynomial: dense output of one step. A
/// *direct* panel turns the sphere by a few radians; its polynomials are those of the quaternion, from omega
/// on Chebyshev nodes or as a Taylor polynomial. A *slow* one, from nodes, may turn it any number of times
/// while the axis changes little. With q = (alpha, gamma), alpha = q_w + i q_z, gamma = q_x - i q_y on axes
/// whose third is that of the spin, zeta = gamma/alpha obeys
///   zeta' = conj(Omega)/2 - i omega_3 zeta + Omega zeta^2/2,   Omega = omega_1 + i omega_2,
/// which has one solution without oscillation, found by collocation without an initial value; the phase of
/// alpha is the integral of (omega_3 - Im(Omega zeta))/2. Its cost does not depend on the angle. Source:
/// docs/theory.md 6.
class RotationPanel {
 public:
  static constexpr int size = polynomials::size;
  /// omega on the nodes, a row each [rad/s].
  using Spin = Eigen::Matrix<double, size, 3>;

  /// Node i, between -1 at the beginning of the panel and 1 at its end: first those of the second half,
  /// ascending, then their opposites.
  static double node(int i);
  static constexpr int last_node = size / 2 - 1;

  struct Fit {
    double error;                ///< what it has cost in accuracy, from the decay of the coefficients [rad]
    double angle;                ///< turned, about [rad]
    double rate;                 ///< abs(omega) near the end [rad/s]
    bool is_truncation = false;  ///< whether the error is that of a truncated series alone, without rounding
  };
  /// @param length  of the panel [s]
  /// @param start   q at its beginning, unit
  /// @return an error of infinity where the method does not converge
  Fit fit_direct(const Spin& omega, double length, const Quaterniond& start = Quaterniond::Identity());
  /// The same from a Taylor polynomial.
  /// @param omega  in the x of at(), a column for each power [rad/s]
  /// @param terms  how many powers there are, > 0; all others vanish
  Fit expand(const polynomials::Powers<3>& omega, int terms, double length,
             const Quaterniond& start = Quaterniond::Identity());
  Fit fit_slow(const Spin& omega, double length, const Quaterniond& start = Quaterniond::Identity());

  /// q, unit.
  /// @param x  as for node()
  Quaterniond at(double x) const {
    const Eigen::Vector4d value = polynomials::values<4>(series_, x);
    return is_slow_ ? slow(value) : near_unit(Quaterniond(value));
  }

 private:
  static Vector3d mean_of(const Spin& omega);
  static double mean_size_of(const Spin& omega);
  static double size_at(const Spin& omega, int i);
  void start_at(const Quaterniond& start);
  Quaterniond slow(const Eigen::Vector4d& value) const;

  bool is_slow_ = false;
  // Powers of x, a column each. Direct: (x, y, z, w) of q. Slow: Re and Im of zeta, and the phase.
  polynomials::Powers<4> series_;
  // Slow: q = frame_ (alpha, gamma) since_.
  Quaterniond frame_ = Quaterniond::Identity();
  Quaterniond since_ = Quaterniond::Identity();
};

}  // namespace hybrid_sphere
