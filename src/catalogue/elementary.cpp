#include "catalogue/elementary.hpp"

#include <cmath>

namespace hybrid_sphere::mechanics::catalogue {
namespace {

constexpr int terms = 20;  // of series of arguments below 1: the next is below 1/20!

// sin(x)/x; below the bound the next term of the series, x^4/120, is less than epsilon.
double sinc(double x) {
  constexpr double bound = 3.3 * 0x1p-13;
  return std::abs(x) >= bound ? std::sin(x) / x : 1 - x * x / 6;
}

// cos and sin of half the angle of (x, y), each to rounding.
struct HalfAngle {
  double cosine = 1;
  double sine = 0;

  HalfAngle(double x, double y) {
    const double length = std::hypot(x, y);
    if (length == 0) return;
    const double larger = std::sqrt((1 + std::abs(x) / length) / 2);
    const double smaller = std::abs(y) / length / (2 * larger);
    cosine = x >= 0 ? larger : smaller;
    sine = std::copysign(x >= 0 ? smaller : larger, y);
  }
};

}  // namespace

const GaussRule gauss_rule{
    {0.0514718425553177, 0.15386991360858354, 0.25463692616788985, 0.3527047255308781, 0.44703376953808915,
     0.5366241481420199, 0.6205261829892429, 0.6978504947933158, 0.7677774321048262, 0.8295657623827684,
     0.8825605357920527, 0.9262000474292743, 0.9600218649683075, 0.9836681232797472, 0.9968934840746495},
    {0.10285265289355884, 0.1017623897484055, 0.09959342058679527, 0.09636873717464425, 0.09212252223778612,
     0.08689978720108298, 0.08075589522942021, 0.0737559747377052, 0.06597422988218049, 0.057493156217619065,
     0.04840267283059405, 0.03879919256962705, 0.02878470788332337, 0.01846646831109096,
     0.007968192496166605}};

Complex arc(double angle, double rate, double time) {
  const double half = rate * time / 2;
  return std::polar(1.0, angle + half) * (time * sinc(half));
}

double sine_gap(double s) {
  if (std::abs(s) >= 1) return (s - std::sin(s)) / (s * s);
  double sum = 0;  // s/3! (1 - s^2/(4 5) (1 - s^2/(6 7) ...))
  for (int k = terms; k >= 4; k -= 2) sum = (1 - sum) * s * s / (k * (k + 1));
  return s / 6 * (1 - sum);
}

Complex exp_difference(const Complex& a) {
  if (std::norm(a) >= 1) return (std::exp(a) - 1.0) / a;
  Complex sum = 1;
  for (int k = terms; k >= 1; --k) sum = 1.0 + sum * a / static_cast<double>(k + 1);
  return sum;
}

Complex exp_difference(const Complex& a, const Complex& b) {
  if (std::norm(a) >= 1 || std::norm(b) >= 1) return (exp_difference(a) - exp_difference(b)) / (a - b);
  // sum of h_k(a, b)/(k + 2)! with the complete homogeneous symmetric polynomials h_k = a^k + b h_(k-1).
  Complex power = 1;
  Complex h = 1;
  double factorial = 2;
  Complex sum = h / factorial;
  for (int k = 1; k <= terms; ++k) {
    power *= a;
    h = power + b * h;
    factorial *= k + 2;
    sum += h / factorial;
  }
  return sum;
}

Relaxation Relaxation::from(double x, double y, double rate, double time) {
  if (rate < 0) {  // pi - psi falls
    Relaxation mirrored = from(-x, y, -rate, time);
    mirrored.cosine *= -1;
    mirrored.cosine_integral *= -1;
    return mirrored;
  }
  const HalfAngle start(x, y);
  if (start.cosine == 0) return {-1, 0, -time, 0};
  const double exponent = rate * time;
  const double s = start.sine * std::exp(-exponent);
  const double length = std::hypot(start.cosine, s);
  const double cosine = start.cosine / length;
  const double sine = s / length;
  Relaxation result;
  result.cosine = (cosine - sine) * (cosine + sine);
  result.sine = 2 * cosine * sine;
  if (rate == 0) {
    result.cosine_integral = result.cosine * time;
    result.sine_integral = result.sine * time;
    return result;
  }
  // tan((psi1 - psi)/2)
  const double opposite = -std::expm1(-exponent) * start.sine * start.cosine;
  const double adjacent = start.cosine * start.cosine + start.sine * s;
  result.sine_integral = 2 * std::atan2(opposite, adjacent) / rate;
  const double change = start.sine * start.sine * std::expm1(-2 * exponent);  // of length^2, from 1
  const double log_length = change > -0.5 ? std::log1p(change) / 2 : std::log(length);
  result.cosine_integral = time + 2 * log_length / rate;
  return result;
}

}  // namespace hybrid_sphere::mechanics::catalogue
