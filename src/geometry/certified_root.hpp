#pragma once

#include <functional>

/// Roots of a smooth function on an interval, none of which can be missed, however close two of them lie.
/// Source: docs/theory.md 5.3.
namespace hybrid_sphere::geometry {

/// A function, its derivative, and a bound on the rounding error of its value, at one place.
struct Jet {
  double value;
  double slope;
  double noise;
};

/// A root, or a place where the function touches zero as far as rounding lets one see.
struct Root {
  double time;
  double error;  ///< bound on the error of time
};

struct Interval {
  double low;
  double high;
};

namespace detail {

Root refined_root(const std::function<Jet(double)>& g, double low, double high, double at_low,
                  double at_high);

void certified_roots(const std::function<Jet(double)>& g,
                     const std::function<double(double, double)>& curvature, double low, double high,
                     const std::function<bool(const Root&)>& report);

}  // namespace detail

/// The root between two places where g has the values at_low and at_high, of different signs.
template <class Function>
Root refined_root(const Function& g, double low, double high, double at_low, double at_high) {
  // A reference finds room in a std::function without memory of its own.
  return detail::refined_root(std::cref(g), low, high, at_low, at_high);
}

/// Reports, ascending, every root of g in [low, high]. With midpoint m, half width w and M >= |g''| an
/// interval has no root if |g(m)| > |g'(m)| w + M w^2/2 and is monotone if |g'(m)| > M w; otherwise it is
/// halved. What cannot be told from zero over an interval of the width of rounding is reported once.
/// @param g          double -> Jet
/// @param curvature  (from, until) -> bound on |g''| between the two
/// @param report     Root -> bool, false to stop
template <class Function, class Curvature, class Report>
void certified_roots(const Function& g, const Curvature& curvature, double low, double high,
                     const Report& report) {
  detail::certified_roots(std::cref(g), std::cref(curvature), low, high, std::cref(report));
}

}  // namespace hybrid_sphere::geometry
