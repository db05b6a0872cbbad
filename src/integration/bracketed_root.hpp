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

/// A bracket as narrow as twice the rounding of its ends, with a change of sign between them. Where the value
/// is flat to rounding, as next to a root that lies at the beginning of a long interval, it is halved by the
/// numbers that binary64 has in it.
/// @param at_low, at_high  values at the ends, of different signs
template <class Function>
Bracket bracketed_root(const Function& value, double low, double high, double at_low, double at_high) {
  return detail::bracketed_root(std::cref(value), low, high, at_low, at_high);
}

}  // namespace hybrid_sphere::integration
