#pragma once

#include <cmath>
#include <complex>

#include "geometry/vectors.hpp"
#include "hybrid_sphere/sphere/twist.hpp"

/// Functions for linear motion that lose no digits when their arguments vanish. A vector (x, y) is written as
/// the complex number x + i y; a turn by +90 degrees is then the factor i. Source: docs/theory.md 4.2.
namespace hybrid_sphere {

using Complex = std::complex<double>;

inline Complex to_complex(const Vector2d& v) { return {v.x(), v.y()}; }
inline Vector2d to_vector(const Complex& z) { return {z.real(), z.imag()}; }

/// The product of finite numbers: that of std::complex looks for infinite factors.
inline Complex times(const Complex& a, const Complex& b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

/// (e^x - 1)/x, 1 at 0.
inline double phi1(double x) { return x == 0 ? 1 : std::expm1(x) / x; }

/// e^x, (e^x - 1)/x and (e^x - 1 - x)/x^2 at once, 1, 1 and 1/2 at 0.
struct Phis {
  double zero;
  double one;
  double two;
};
Phis phis_off_zero(double x);
inline Phis phis(double x) { return x == 0 ? Phis{1, 1, 0.5} : phis_off_zero(x); }

/// e^z - 1.
Complex expm1(const Complex& z);
/// (e^z - 1)/z, 1 at 0.
Complex phi1(const Complex& z);
/// (e^z - 1 - z)/z^2, 1/2 at 0.
Complex phi2(const Complex& z);

/// Response of x'' = beta x' + gamma x + a to its initial velocity and to a:
///   x = x'(0) G + a H,   x' = x'(0) G' + a G,   x(0) = 0
/// With the roots l_1, l_2 of l^2 = beta l + gamma these are divided differences of the exponential:
/// G = t exp[l_1 t, l_2 t], H = t^2 exp[l_1 t, l_2 t, 0].
struct Response {
  Complex rate;     ///< G' [1]
  Complex impulse;  ///< G [s]
  Complex step;     ///< H [s^2]
};

class LinearResponse {
 public:
  LinearResponse() = default;
  /// @param beta   [1/s]
  /// @param gamma  [1/s^2]
  LinearResponse(const Complex& beta, const Complex& gamma);

  /// Real where beta and gamma are.
  Response at(double time) const;

  const Complex& beta() const { return beta_; }
  const Complex& gamma() const { return gamma_; }
  const Complex& larger_root() const { return larger_; }    ///< in modulus [1/s]
  const Complex& smaller_root() const { return smaller_; }  ///< [1/s]
  /// max(0, Re l_1, Re l_2) [1/s].
  double growth() const;

 private:
  Response complex_at(double time) const;
  Response without_spring(double time) const;
  Response oscillation(double time) const;

  Complex beta_ = 0;
  Complex gamma_ = 0;
  Complex larger_ = 0;
  Complex smaller_ = 0;
  Complex slower_ = 0;      // the root with the larger real part
  Complex difference_ = 0;  // the other root minus slower_
};

}  // namespace hybrid_sphere
