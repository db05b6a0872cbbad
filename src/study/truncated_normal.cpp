#include "study/truncated_normal.hpp"

#include <algorithm>
#include <cmath>

#include "study/inverse_erf.hpp"

namespace hybrid_sphere::study {
namespace {

// In deviations from the mean.
constexpr double far_limit = 30;       // beyond it the series of tail_exponent() is good to rounding
constexpr double narrow_width = 1e-6;  // below it the logarithm of the density is linear to w^2/8 = 1e-13
constexpr double least_rate = 1e-16;   // of change of the density: below it the distribution is uniform

/// The limits in deviations from the mean, mirrored if need be so that their middle is not below the mean.
struct Limits {
  double a;
  double b;
  double width;
  bool mirrored;
};

Limits limits_of(const TruncatedNormal& d) {
  const double below = d.low - d.mean;
  const double above = d.high - d.mean;
  const double width = (d.high - d.low) / d.deviation;
  if (below + above < 0) return {-above / d.deviation, -below / d.deviation, width, true};
  return {below / d.deviation, above / d.deviation, width, false};
}

/// -ln Q(a + t)/Q(a) for the upper tail Q of the normal distribution, a >= far_limit: the integral of the
/// hazard rate z + 1/z - 2/z^3 + 10/z^5 - ..., from the asymptotic series of Mills' ratio (M. Abramowitz,
/// I. A. Stegun, Handbook of Mathematical Functions, 26.2.12).
double tail_exponent(double a, double t) {
  // The integral beyond z^2/2 + ln z, as a polynomial in 1/z^2, and its divided difference.
  constexpr double coefficients[] = {-110410. / 12, 816.2, -88.25, 37. / 3, -2.5, 1, 0};
  const double z = a + t;
  const double from = 1 / (a * a);
  const double to = 1 / (z * z);
  double value = 0;
  double slope = 0;
  for (const double c : coefficients) {
    slope = slope * to + value;
    value = value * from + c;
  }
  return t * (a + t / 2) + std::log1p(t / a) - slope * t * (2 * a + t) * from * to;
}

/// What is between the limits, where it falls off like an exponential: far from the mean, or between limits
/// so close to each other that the density is one. t is the distance from the limit at the mean's side.
class Decline {
 public:
  explicit Decline(const Limits& limits) : a_(std::min(limits.a, 1e100)), width_(limits.width) {
    constexpr double nothing = 750;  // exp(-750) is 0
    if (a_ > 1) width_ = std::min(width_, nothing / a_);
    narrow_ = width_ < narrow_width;
    rate_ = a_ + width_ / 2;
    whole_ = exponent(width_);
  }

  double width() const { return width_; }

  /// The distance within which the share u lies; v = 1 - u.
  double distance(double u, double v) const {
    if (whole_ < least_rate) return u * width_;
    const double within = -u * std::expm1(-whole_);
    const double wanted = within < 0.5 ? -std::log1p(-within) : -std::log(v + u * std::exp(-whole_));
    if (narrow_) return wanted / rate_;
    double t = 2 * wanted / (a_ + std::sqrt(a_ * a_ + 2 * wanted));  // of z^2/2 alone: good to 1/a^2
    for (int i = 0; i < 3; ++i) t -= (exponent(t) - wanted) / hazard(t);
    return t;
  }

  double share_within(double t) const {
    if (whole_ < least_rate) return t / width_;
    return std::expm1(-exponent(t)) / std::expm1(-whole_);
  }

  double share_beyond(double t) const {
    if (whole_ < least_rate) return (width_ - t) / width_;
    return std::exp(-exponent(t)) * std::expm1(exponent(t) - whole_) / std::expm1(-whole_);
  }

 private:
  /// -ln of the share beyond t if there were no further limit.
  double exponent(double t) const { return narrow_ ? rate_ * t : tail_exponent(a_, t); }

  /// Slope of the exponent, to 10/z^6.
  double hazard(double t) const {
    const double z = a_ + t;
    return z + 1 / z - 2 / (z * z * z);
  }

  double a_;
  double width_;
  bool narrow_ = false;
  double rate_ = 0;   // of a narrow one
  double whole_ = 0;  // exponent at the further limit
};

bool declines(const Limits& limits) { return limits.a >= far_limit || limits.width < narrow_width; }

/// The z below which the share u of what is between the limits lies; v = 1 - u. No difference of nearly equal
/// numbers is taken that the result hangs on.
double central_quantile(const Limits& limits, double u, double v) {
  const double a = limits.a / M_SQRT2;
  const double b = limits.b / M_SQRT2;
  const double p = v * std::erf(a) + u * std::erf(b);
  if (p > 0.5) return M_SQRT2 * inverse_erfc(v * std::erfc(a) + u * std::erfc(b));
  if (p < -0.5) return -M_SQRT2 * inverse_erfc(v * std::erfc(-a) + u * std::erfc(-b));
  return M_SQRT2 * inverse_erf(p);
}

/// Twice the probability of the normal distribution between two numbers.
double between(double from, double to) {
  const double a = from / M_SQRT2;
  const double b = to / M_SQRT2;
  if (a > 0.5) return std::erfc(a) - std::erfc(b);
  if (b < -0.5) return std::erfc(-b) - std::erfc(-a);
  return std::erf(b) - std::erf(a);
}

}  // namespace

double quantile(const TruncatedNormal& d, double u) {
  const Limits limits = limits_of(d);
  const double above = 1 - u;
  const double towards = limits.mirrored ? above : u;  // from the limit at the mean's side
  const double rest = limits.mirrored ? u : above;
  const double sign = limits.mirrored ? -1 : 1;
  double x = 0;
  if (declines(limits)) {
    x = (limits.mirrored ? d.high : d.low) + sign * d.deviation * Decline(limits).distance(towards, rest);
  } else {
    x = d.mean + sign * d.deviation * central_quantile(limits, towards, rest);
  }
  return std::clamp(x, d.low, d.high);
}

double cumulative(const TruncatedNormal& d, double x) {
  if (x <= d.low) return 0;
  if (x >= d.high) return 1;
  const Limits limits = limits_of(d);
  if (declines(limits)) {
    const Decline decline(limits);
    const double distance = (limits.mirrored ? d.high - x : x - d.low) / d.deviation;
    const double t = std::min(distance, decline.width());
    return limits.mirrored ? decline.share_beyond(t) : decline.share_within(t);
  }
  const double z = (x - d.mean) / d.deviation;
  const double share = limits.mirrored ? between(-z, limits.b) : between(limits.a, z);
  return std::clamp(share / between(limits.a, limits.b), 0.0, 1.0);
}

}  // namespace hybrid_sphere::study
