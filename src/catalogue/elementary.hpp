#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <optional>

/// Functions of which known motions are made, written so that they lose no digits where a rate tends to 0.
namespace hybrid_sphere::mechanics::catalogue {

using Complex = std::complex<double>;

/// The path at unit speed whose direction turns steadily: the integral of exp(i (angle + rate s)) over s from
/// 0 to time.
Complex arc(double angle, double rate, double time);

/// (s - sin s)/s^2; 0 at s = 0.
double sine_gap(double s);

/// (e^a - 1)/a, the divided difference of exp at 0 and a; 1 at a = 0.
Complex exp_difference(const Complex& a);

/// The divided difference of exp at 0, a and b, (exp_difference(a) - exp_difference(b))/(a - b); 1/2 at a = b
/// = 0. Accurate where abs(a - b) is not much smaller than abs(a) and abs(b), or both are below 1.
Complex exp_difference(const Complex& a, const Complex& b);

/// Half of a Gauss rule of 30 points on [-1, 1], which integrates polynomials of degree 59: the nodes above
/// 0, which are roots of the Legendre polynomial P_30, and their weights. Those below 0 mirror them.
struct GaussRule {
  static constexpr std::size_t size = 15;
  std::array<double, size> nodes;
  std::array<double, size> weights;
};
extern const GaussRule gauss_rule;

/// The integral of an analytic function over [0, time] to rounding, by panels of a Gauss rule of degree 59;
/// empty where it takes more than ten thousand of them.
/// @param velocity  Complex velocity(double t)
/// @param panel     length of time in which `velocity` changes by a few of its size and turns by 4 rad
///                  at most
template <class Function>
std::optional<Complex> path(Function velocity, double time, double panel) {
  const double panels = std::ceil(time / panel);
  if (!(panels <= 1e4)) return std::nullopt;
  Complex sum = 0;
  for (double i = 0; i < panels; ++i) {
    const double begin = time * (i / panels), end = time * ((i + 1) / panels);
    const double middle = (begin + end) / 2, half = (end - begin) / 2;
    Complex mean_twice = 0;
    for (std::size_t k = 0; k < GaussRule::size; ++k) {
      const double step = half * gauss_rule.nodes[k];
      mean_twice += (velocity(middle + step) + velocity(middle - step)) * gauss_rule.weights[k];
    }
    sum += half * mean_twice;
  }
  return sum;
}

/// An angle psi that falls to 0 by psi' = -rate sin(psi): the hyperbolic motion
/// tan(psi/2) = tan(psi1/2) exp(-rate time), and its integrals over the time.
struct Relaxation {
  double cosine = 1;           ///< cos(psi)
  double sine = 0;             ///< sin(psi)
  double cosine_integral = 0;  ///< of cos(psi): -ln(sin(psi)/sin(psi1))/rate
  double sine_integral = 0;    ///< of sin(psi): (psi1 - psi)/rate

  /// From the direction (x, y) = length (cos(psi1), sin(psi1)); of any rate, 0 and less included.
  static Relaxation from(double x, double y, double rate, double time);
};

}  // namespace hybrid_sphere::mechanics::catalogue
