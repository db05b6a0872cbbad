#include "geometry/certified_root.hpp"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <limits>
#include <optional>

#include "hybrid_sphere/numerical_error.hpp"
#include "integration/bracketed_root.hpp"
#include "interrupt/interrupt.hpp"

namespace hybrid_sphere::geometry {

namespace {

/// A change of sign: where, and the values on both sides.
struct SignChange {
  double low;
  double high;
  double at_low;
  double at_high;
};

/// Newton's method, halving where it would leave the bracket, which it makes narrower.
/// @return none where that does not converge in a few steps
std::optional<Root> root_by_newton(const std::function<Jet(double)>& g, SignChange& bracket) {
  constexpr int few = 12;
  constexpr double much_shorter = 0x1p-8;
  const double width = bracket.high - bracket.low;
  const bool falls = bracket.at_low > 0;
  double time = bracket.low + width * (bracket.at_low / (bracket.at_low - bracket.at_high));
  if (!(bracket.low < time && time < bracket.high)) time = bracket.low + 0.5 * width;
  double last = 0;  // Newton's last step, if there is one
  for (int i = 0; i < few; ++i) {
    const Jet jet = g(time);
    const double step = -jet.value / jet.slope;
    const double next = time + step;
    const double rounding = DBL_EPSILON * std::abs(time);
    const bool is_inside = bracket.low <= next && next <= bracket.high;
    // Each step is the square of the one before it, but for a factor: the last two tell the next one.
    const double error = std::abs(step) * std::min(1.0, (step / last) * (step / last));
    const bool converges = std::abs(step) <= much_shorter * std::abs(last);
    const bool is_known = std::abs(jet.value) <= jet.noise || error <= 0.25 * rounding;
    if (is_inside && converges && is_known) {
      return Root{next, error + rounding + std::min(jet.noise / std::abs(jet.slope), width)};
    }
    if ((jet.value > 0) == falls) {
      bracket.low = time;
      bracket.at_low = jet.value;
    } else {
      bracket.high = time;
      bracket.at_high = jet.value;
    }
    last = is_inside ? step : 0;
    time = is_inside ? next : bracket.low + 0.5 * (bracket.high - bracket.low);
  }
  return std::nullopt;
}

}  // namespace

Root detail::refined_root(const std::function<Jet(double)>& g, double low, double high, double at_low,
                          double at_high) {
  SignChange change{low, high, at_low, at_high};
  if (const std::optional<Root> root = root_by_newton(g, change)) return *root;
  const auto value = [&g](double t) { return g(t).value; };
  const integration::Bracket bracket =
      integration::bracketed_root(value, change.low, change.high, change.at_low, change.at_high);
  const double time = 0.5 * (bracket.low + bracket.high);
  const Jet there = g(time);
  const double width = bracket.high - bracket.low + DBL_EPSILON * std::abs(time);
  return {time, width + std::min(there.noise / std::abs(there.slope), high - low)};
}

namespace {

/// Where g is monotone there is at most one root: an end that rounding cannot tell from zero, or a change of
/// sign.
bool root_of_monotone(const std::function<Jet(double)>& g, const Interval& interval, Root& root) {
  const Jet low = g(interval.low);
  const Jet high = g(interval.high);
  const auto near_zero = [](const Jet& jet) { return std::abs(jet.value) <= jet.noise; };
  const auto at = [&](double time, const Jet& jet) {
    const double error = std::min(2 * jet.noise / std::abs(jet.slope), interval.high - interval.low);
    return Root{time, error + DBL_EPSILON * std::abs(time)};
  };
  if (near_zero(low)) {
    root = at(interval.low, low);
  } else if (near_zero(high)) {
    root = at(interval.high, high);
  } else if ((low.value < 0) != (high.value < 0)) {
    root = detail::refined_root(g, interval.low, interval.high, low.value, high.value);
  } else {
    return false;
  }
  return true;
}

}  // namespace

void detail::certified_roots(const std::function<Jet(double)>& g,
                             const std::function<double(double, double)>& curvature, double low, double high,
                             const std::function<bool(const Root&)>& report) {
  std::array<Interval, 1100> stack;  // a double can be halved so often
  std::size_t size = 0;
  stack[size++] = {low, high};
  double told = -std::numeric_limits<double>::infinity();  // roots up to here are known
  const auto tell = [&](const Root& root) {
    const bool is_new = root.time - root.error > told;
    told = std::max(told, root.time + root.error);
    return !is_new || report(root);
  };
  while (size > 0) {
    interruption_point();
    const Interval interval = stack[--size];
    const double middle = interval.low + 0.5 * (interval.high - interval.low);
    const double half = 0.5 * (interval.high - interval.low);
    const Jet jet = g(middle);
    if (std::isnan(jet.value) || std::isnan(jet.slope)) {
      throw NumericalError("a search for roots leaves the range of binary64");
    }
    const double bend = curvature(interval.low, interval.high) * half;
    const double reach = std::abs(jet.slope) * half + 0.5 * bend * half;
    if (std::abs(jet.value) - jet.noise > reach) continue;
    if (std::abs(jet.slope) > bend) {
      Root root{};
      if (root_of_monotone(g, interval, root) && !tell(root)) return;
      continue;
    }
    const bool finest = half <= 2 * DBL_EPSILON * std::abs(middle) || middle == interval.low ||
                        middle == interval.high || std::abs(jet.value) + reach <= jet.noise;
    if (finest) {
      if (!tell({middle, half + DBL_EPSILON * std::abs(middle)})) return;
      continue;
    }
    stack[size++] = {middle, interval.high};
    stack[size++] = {interval.low, middle};
  }
}

}  // namespace hybrid_sphere::geometry
