#include "study/distribution.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "study/inverse_erf.hpp"
#include "study/truncated_normal.hpp"

namespace hybrid_sphere::study {
namespace {

/// Of mean 0 and deviation 1. 1 - u is exact where it is used.
double normal_quantile(double u) {
  return u < 0.5 ? -M_SQRT2 * inverse_erfc(2 * u) : M_SQRT2 * inverse_erfc(2 * (1 - u));
}

double normal_cumulative(double z) { return std::erfc(-z / M_SQRT2) / 2; }

/// ln(y/x) of positive numbers, also of those close to each other and of those whose quotient overflows.
double log_quotient(double x, double y) {
  const double quotient = y / x;
  if (quotient > 0.5 && quotient < 2) return std::log1p((y - x) / x);
  if (std::isnormal(quotient)) return std::log(quotient);
  return std::log(y) - std::log(x);
}

double quantile(const Uniform& d, double u) { return std::min(d.low + u * (d.high - d.low), d.high); }

double cumulative(const Uniform& d, double x) { return (x - d.low) / (d.high - d.low); }

double quantile(const LogUniform& d, double u) {
  // From the nearer end, so that no exponential overflows.
  const double whole = log_quotient(d.low, d.high);
  const double middle = std::clamp(std::sqrt(d.low) * std::sqrt(d.high), d.low, d.high);
  if (u < 0.5) return std::clamp(d.low * std::exp(u * whole), d.low, middle);
  return std::clamp(d.high * std::exp((u - 1) * whole), middle, d.high);
}

double cumulative(const LogUniform& d, double x) {
  return x <= d.low ? 0 : log_quotient(d.low, x) / log_quotient(d.low, d.high);
}

double quantile(const Normal& d, double u) { return d.mean + d.deviation * normal_quantile(u); }

double cumulative(const Normal& d, double x) { return normal_cumulative((x - d.mean) / d.deviation); }

double quantile(const Lognormal& d, double u) {
  using Limits = std::numeric_limits<double>;
  return std::clamp(d.median * std::exp(d.log_deviation * normal_quantile(u)), Limits::min(), Limits::max());
}

double cumulative(const Lognormal& d, double x) {
  return x <= 0 ? 0 : normal_cumulative(log_quotient(d.median, x) / d.log_deviation);
}

double quantile(const Triangular& d, double u) {
  const double width = d.high - d.low;
  const double below = (d.mode - d.low) / width;  // share of samples below the mode
  const double above = (d.high - d.mode) / width;
  if (u < below) return std::min(d.low + width * std::sqrt(u * below), d.mode);
  return std::max(d.high - width * std::sqrt((1 - u) * above), d.mode);
}

double cumulative(const Triangular& d, double x) {
  const double width = d.high - d.low;
  if (x <= d.low) return 0;
  if (x >= d.high) return 1;
  if (x < d.mode) return (x - d.low) / width * ((x - d.low) / (d.mode - d.low));
  return 1 - (d.high - x) / width * ((d.high - x) / (d.high - d.mode));
}

double quantile(const Values& d, double u) {
  const auto found = std::lower_bound(d.until.begin(), d.until.end(), u);
  return d.values[static_cast<std::size_t>(found - d.until.begin())];
}

double cumulative(const Values& d, double x) {
  const auto above = std::upper_bound(d.values.begin(), d.values.end(), x);
  return above == d.values.begin() ? 0 : d.until[static_cast<std::size_t>(above - d.values.begin()) - 1];
}

}  // namespace

double quantile(const Distribution& distribution, double u) {
  return std::visit([u](const auto& d) { return quantile(d, u); }, distribution);
}

double cumulative(const Distribution& distribution, double x) {
  return std::visit([x](const auto& d) { return std::clamp(cumulative(d, x), 0.0, 1.0); }, distribution);
}

}  // namespace hybrid_sphere::study
