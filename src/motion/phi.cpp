#include "motion/phi.hpp"

#include <algorithm>
#include <limits>

namespace hybrid_sphere {
namespace {

struct InverseFactorials {
  double values[25] = {};
  constexpr InverseFactorials() {
    double factorial = 1;
    for (int k = 0; k < 25; factorial *= ++k) values[k] = 1 / factorial;
  }
};
constexpr InverseFactorials inverse_factorials;

constexpr double inverse_factorial(int k) { return inverse_factorials.values[k]; }

// Both roots times t below 1. Complete homogeneous symmetric polynomials h_k of them, divided by factorials.
template <class Number>
Response response_by_series(const Number& beta, const Number& gamma, double time) {
  const Number first = beta * time;
  const Number second = gamma * time * time;
  Number before = 0;
  Number now = 1;
  Number rate = 1;
  Number impulse = 1;
  Number step = 0.5;
  for (int k = 1; k <= 22; ++k) {
    const Number next = first * now + second * before;
    before = now;
    now = next;
    rate += inverse_factorial(k) * now;
    impulse += inverse_factorial(k + 1) * now;
    step += inverse_factorial(k + 2) * now;
  }
  return {rate, impulse * time, step * (time * time)};
}

// Sum of z^k/(k + 2)! for |z| < 1: what is left out is below 2^-53 of it. Without std::complex, whose
// products look for infinite factors.
Complex phi2_series(const Complex& z) {
  const double x = z.real();
  const double y = z.imag();
  int k = std::norm(z) < 0x1p-4 ? 11 : 17;
  double re = inverse_factorial(k + 2);
  double im = 0;
  while (k-- > 0) {
    const double next = inverse_factorial(k + 2) + (x * re - y * im);
    im = x * im + y * re;
    re = next;
  }
  return {re, im};
}

/// Sum of x^k/(k + 2)! for |x| < 1, even and odd powers apart: what is left out is below 2^-54 of it.
double phi2_series(double x) {
  constexpr int last = 16;
  const double square = x * x;
  double even = inverse_factorial(last + 2);
  double odd = inverse_factorial(last + 1);
  for (int k = last - 2; k > 0; k -= 2) {
    even = even * square + inverse_factorial(k + 2);
    odd = odd * square + inverse_factorial(k + 1);
  }
  return (even * square + inverse_factorial(2)) + x * odd;
}

}  // namespace

Phis phis_off_zero(double x) {
  if (std::abs(x) < 1) {
    const double two = phi2_series(x);
    const double one = 1 + x * two;
    return {1 + x * one, one, two};
  }
  // Each of e^x and e^x - 1 from the smaller of them.
  const bool decays = x < 0;
  const double smaller = decays ? std::exp(x) : std::expm1(x);
  const double one = (decays ? smaller - 1 : smaller) / x;
  return {decays ? smaller : 1 + smaller, one, (one - 1) / x};
}

Complex expm1(const Complex& z) {
  const double half_sine = std::sin(0.5 * z.imag());
  const double growth = std::expm1(z.real());
  return {growth * std::cos(z.imag()) - 2 * half_sine * half_sine, (1 + growth) * std::sin(z.imag())};
}

Complex phi1(const Complex& z) { return std::norm(z) < 1 ? 1.0 + z * phi2_series(z) : expm1(z) / z; }

Complex phi2(const Complex& z) { return std::norm(z) < 1 ? phi2_series(z) : (phi1(z) - 1.0) / z; }

LinearResponse::LinearResponse(const Complex& beta, const Complex& gamma) : beta_(beta), gamma_(gamma) {
  // Half a sum in which nothing cancels; the other root from the product of both, -gamma.
  const Complex half = 0.5 * beta;
  Complex root = gamma == 0.0 ? half : std::sqrt(half * half + gamma);
  if ((std::conj(half) * root).real() < 0) root = -root;
  larger_ = half + root;
  if (gamma != 0.0) smaller_ = -gamma / larger_;
  const bool larger_is_slower = larger_.real() > smaller_.real();
  slower_ = larger_is_slower ? larger_ : smaller_;
  difference_ = larger_is_slower ? -2.0 * root : 2.0 * root;
}

double LinearResponse::growth() const { return std::max(0.0, slower_.real()); }

// Where both coefficients are real the responses are too, also from a pair of complex roots. An imaginary
// part of rounding would carry one component of a motion into the other, where that may be smaller by any
// factor.
Response LinearResponse::at(double time) const {
  if (beta_ == 0.0 && gamma_ == 0.0) return {1.0, time, 0.5 * time * time};
  const bool real = beta_.imag() == 0 && gamma_.imag() == 0;
  if (real && gamma_ == 0.0) {
    const Phis phi = phis(beta_.real() * time);
    return {phi.zero, phi.one * time, phi.two * time * time};
  }
  const bool near = std::norm(larger_ * time) < 1;
  if (real && near) return response_by_series(beta_.real(), gamma_.real(), time);
  const bool oscillates = std::abs(larger_.imag()) >= 0x1p-10 * std::abs(larger_.real());
  if (real && oscillates) return oscillation(time);
  const Response response = complex_at(time);
  if (!real) return response;
  return {response.rate.real(), response.impulse.real(), response.step.real()};
}

/// With gamma = 0 the smaller root is 0.
Response LinearResponse::without_spring(double time) const {
  const Complex z = beta_ * time;
  if (std::norm(z) < 1) {
    const Complex second = phi2_series(z);
    const Complex first = 1.0 + times(z, second);
    return {1.0 + times(z, first), first * time, second * time * time};
  }
  // e^z - 1 as a difference: where it is small the phase has the error, not the difference.
  const double growth = z.real() == 0 ? 1 : std::exp(z.real());
  const Complex rate(growth * std::cos(z.imag()), growth * std::sin(z.imag()));
  const double size = std::norm(z);
  const Complex inverse(z.real() / size, -z.imag() / size);
  const Complex first = times(rate - 1.0, inverse);
  return {rate, first * time, times(first - 1.0, inverse) * time * time};
}

/// Real coefficients, and a pair of roots -d +- i w:
///   G = e^(-d t) sin(w t)/w,   G' = e^(-d t) (cos(w t) - d/w sin(w t)),   H = (1 - e^(-d t) (cos(w t) + d/w
///   sin(w t)))/(d^2 + w^2)
Response LinearResponse::oscillation(double time) const {
  const double decay = std::exp(larger_.real() * time);
  const double rate = std::abs(larger_.imag());
  const double sine = decay * std::sin(rate * time) / rate;
  const double cosine = decay * std::cos(rate * time);
  const double drift = -larger_.real() * sine;
  return {cosine - drift, sine, (1 - (cosine + drift)) / -gamma_.real()};
}

Response LinearResponse::complex_at(double time) const {
  if (gamma_ == 0.0) return without_spring(time);
  const Complex larger = larger_ * time;
  if (std::norm(larger) < 1) return response_by_series(beta_, gamma_, time);
  const Complex smaller = smaller_ * time;
  const Complex impulse = std::exp(slower_ * time) * phi1(difference_ * time);
  const Complex step = (impulse - phi1(smaller)) / larger;
  const Complex rate = std::exp(larger) + smaller * impulse;
  return {rate, impulse * time, step * time * time};
}

}  // namespace hybrid_sphere
