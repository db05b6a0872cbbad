#include "hybrid_sphere/sphere/phi.hpp"

#include <algorithm>
#include <limits>

namespace hybrid_sphere {
namespace {

// sum of z^k/(k + order)! for |z| < 1: the twentieth term is below 1/20!.
Complex phi_series(const Complex& z, int order) {
  constexpr int terms = 20;
  Complex sum = 1;
  for (int k = terms; k >= 1; --k) sum = 1.0 + sum * z / static_cast<double>(k + order);
  return order == 2 ? 0.5 * sum : sum;
}

}  // namespace

Complex expm1(const Complex& z) {
  const double half_sine = std::sin(0.5 * z.imag());
  const double growth = std::expm1(z.real());
  return {growth * std::cos(z.imag()) - 2 * half_sine * half_sine, (1 + growth) * std::sin(z.imag())};
}

Complex phi1(const Complex& z) { return std::norm(z) < 1 ? phi_series(z, 1) : expm1(z) / z; }

Complex phi2(const Complex& z) { return std::norm(z) < 1 ? phi_series(z, 2) : (phi1(z) - 1.0) / z; }

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

Response LinearResponse::series(double time) const {
  const Complex first = beta_ * time;
  const Complex second = gamma_ * time * time;
  // Complete homogeneous symmetric polynomials h_k of both roots times t.
  Complex before = 0;
  Complex now = 1;
  Complex rate = 1;
  Complex impulse = 1;
  Complex step = 0.5;
  double factorial = 1;  // k!
  for (int k = 1; k <= 22; ++k) {
    const Complex next = first * now + second * before;
    before = now;
    now = next;
    factorial *= k;
    const Complex term = now / factorial;
    rate += term;
    impulse += term / static_cast<double>(k + 1);
    step += term / static_cast<double>((k + 1) * (k + 2));
  }
  return {rate, impulse * time, step * time * time};
}

// Where both coefficients are real the responses are too, also from a pair of complex roots. An imaginary
// part of rounding would carry one component of a motion into the other, where that may be smaller by any
// factor.
Response LinearResponse::at(double time) const {
  const Response response = complex_at(time);
  if (beta_.imag() != 0 || gamma_.imag() != 0) return response;
  return {response.rate.real(), response.impulse.real(), response.step.real()};
}

Response LinearResponse::complex_at(double time) const {
  if (gamma_ == 0.0) {
    if (beta_ == 0.0) return {1.0, time, 0.5 * time * time};
    const Complex z = beta_ * time;
    const Complex first = phi1(z);
    const Complex second = std::norm(z) < 1 ? phi2(z) : (first - 1.0) / z;
    return {std::exp(z), first * time, second * time * time};
  }
  const Complex larger = larger_ * time;
  if (std::norm(larger) < 1) return series(time);
  const Complex smaller = smaller_ * time;
  const Complex impulse = std::exp(slower_ * time) * phi1(difference_ * time);
  const Complex step = (impulse - phi1(smaller)) / larger;
  const Complex rate = std::exp(larger) + smaller * impulse;
  return {rate, impulse * time, step * time * time};
}

}  // namespace hybrid_sphere
