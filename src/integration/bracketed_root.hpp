#pragma once

#include <functional>

namespace hybrid_sphere::integration {

/// Two places between which a function changes its sign.
struct Bracket {
  double low;
  double high;
};

namespace detail {

Bracket bracketed_root(const std::function<double(double)>& value, double low, double high, double at_low,
                       double at_high);

}  // namespace detail

/// A bracket as narrow as twice the rounding of its ends, with a change of sign between them. If the value is
/// flat to rounding, as near a root at the beginning of a long interval, the bracket is halved by the count
/// of binary64 numbers in it.
/// @param at_low, at_high  values at the ends, of different signs
template <class Function>
Bracket bracketed_root(const Function& value, double low, double high, double at_low, double at_high) {
  return detail::bracketed_root(std::cref(value), low, high, at_low, at_high);
}

/// A bracket after so many halvings, of a change that may be no change of sign.
/// @param is_before  bool(double place): whether the change lies after it; true at low, false at high
template <class IsBefore>
Bracket halved(Bracket bracket, int times, const IsBefore& is_before) {
  for (int i = 0; i < times; ++i) {
    const double middle = 0.5 * (bracket.low + bracket.high);
    (is_before(middle) ? bracket.low : bracket.high) = middle;
  }
  return bracket;
}

}  // namespace hybrid_sphere::integration
