#pragma once

#include <cmath>

#include "hybrid_sphere/mechanics/dual.hpp"

namespace hybrid_sphere::mechanics {

/// First and second derivatives of a function of two numbers.
struct Partials {
  double value;
  double x, y;
  double xx, xy, yy;
};

/// Comparisons and the functions of `cmath` for a Number that has a `value` and the chain rules
///   chain(x, f, f', f'') and chain(x, y, Partials),
/// with the same rules as those of Dual, which differentiates what is not given here.
/// @code
/// const mechanics::Partials product{6, 3, 2, 0, 1, 0};  // of x y at (2, 3)
/// @endcode
template <class Number>
struct ElementaryFunctions {
  friend bool operator==(const Number& a, const Number& b) { return a.value == b.value; }
  friend bool operator!=(const Number& a, const Number& b) { return a.value != b.value; }
  friend bool operator<(const Number& a, const Number& b) { return a.value < b.value; }
  friend bool operator>(const Number& a, const Number& b) { return a.value > b.value; }
  friend bool operator<=(const Number& a, const Number& b) { return a.value <= b.value; }
  friend bool operator>=(const Number& a, const Number& b) { return a.value >= b.value; }

  friend Number abs(const Number& x) { return x.value < 0.0 ? -x : x; }
  friend Number fabs(const Number& x) { return abs(x); }
  friend Number min(const Number& x, const Number& y) { return y < x ? y : x; }
  friend Number max(const Number& x, const Number& y) { return x < y ? y : x; }
  friend Number fmin(const Number& x, const Number& y) { return min(x, y); }
  friend Number fmax(const Number& x, const Number& y) { return max(x, y); }
  friend Number fdim(const Number& x, const Number& y) { return x > y ? x - y : Number(0.0); }
  /// abs(x) with the sign of y.
  friend Number copysign(const Number& x, const Number& y) { return signbit(x) == signbit(y) ? x : -x; }

  // Constant between their jumps.
  friend Number floor(const Number& x) { return std::floor(x.value); }
  friend Number ceil(const Number& x) { return std::ceil(x.value); }
  friend Number round(const Number& x) { return std::round(x.value); }
  friend Number trunc(const Number& x) { return std::trunc(x.value); }
  friend Number rint(const Number& x) { return std::rint(x.value); }
  friend Number nearbyint(const Number& x) { return std::nearbyint(x.value); }

  friend bool isfinite(const Number& x) { return std::isfinite(x.value); }
  friend bool isinf(const Number& x) { return std::isinf(x.value); }
  friend bool isnan(const Number& x) { return std::isnan(x.value); }
  friend bool signbit(const Number& x) { return std::signbit(x.value); }

  friend Number sqrt(const Number& x) {
    const double root = std::sqrt(x.value);
    const double slope = 0.5 / root;
    return chain(x, root, slope, -0.5 * slope / x.value);
  }
  friend Number sin(const Number& x) {
    const double sine = std::sin(x.value);
    return chain(x, sine, std::cos(x.value), -sine);
  }
  friend Number cos(const Number& x) {
    const double cosine = std::cos(x.value);
    return chain(x, cosine, -std::sin(x.value), -cosine);
  }
  friend Number exp(const Number& x) {
    const double power = std::exp(x.value);
    return chain(x, power, power, power);
  }
  friend Number fma(const Number& x, const Number& y, const Number& z) { return x * y + z; }

  friend Number cbrt(const Number& x) {
    return compose([](auto u) { return cbrt(u); }, x);
  }
  friend Number tan(const Number& x) {
    return compose([](auto u) { return tan(u); }, x);
  }
  friend Number asin(const Number& x) {
    return compose([](auto u) { return asin(u); }, x);
  }
  friend Number acos(const Number& x) {
    return compose([](auto u) { return acos(u); }, x);
  }
  friend Number atan(const Number& x) {
    return compose([](auto u) { return atan(u); }, x);
  }
  friend Number sinh(const Number& x) {
    return compose([](auto u) { return sinh(u); }, x);
  }
  friend Number cosh(const Number& x) {
    return compose([](auto u) { return cosh(u); }, x);
  }
  friend Number tanh(const Number& x) {
    return compose([](auto u) { return tanh(u); }, x);
  }
  friend Number asinh(const Number& x) {
    return compose([](auto u) { return asinh(u); }, x);
  }
  friend Number acosh(const Number& x) {
    return compose([](auto u) { return acosh(u); }, x);
  }
  friend Number atanh(const Number& x) {
    return compose([](auto u) { return atanh(u); }, x);
  }
  friend Number expm1(const Number& x) {
    return compose([](auto u) { return expm1(u); }, x);
  }
  friend Number exp2(const Number& x) {
    return compose([](auto u) { return exp2(u); }, x);
  }
  friend Number log(const Number& x) {
    return compose([](auto u) { return log(u); }, x);
  }
  friend Number log2(const Number& x) {
    return compose([](auto u) { return log2(u); }, x);
  }
  friend Number log10(const Number& x) {
    return compose([](auto u) { return log10(u); }, x);
  }
  friend Number log1p(const Number& x) {
    return compose([](auto u) { return log1p(u); }, x);
  }
  friend Number erf(const Number& x) {
    return compose([](auto u) { return erf(u); }, x);
  }
  friend Number erfc(const Number& x) {
    return compose([](auto u) { return erfc(u); }, x);
  }
  friend Number pow(const Number& x, double exponent) {
    return compose([exponent](auto u) { return pow(u, exponent); }, x);
  }
  friend Number pow(double base, const Number& x) {
    return compose([base](auto u) { return pow(base, u); }, x);
  }
  friend Number pow(const Number& x, const Number& exponent) {
    if (is_constant(exponent)) return pow(x, exponent.value);
    return compose([](auto u, auto w) { return pow(u, w); }, x, exponent);
  }
  friend Number hypot(const Number& x, const Number& y) {
    return compose([](auto u, auto w) { return hypot(u, w); }, x, y);
  }
  friend Number hypot(const Number& x, const Number& y, const Number& z) { return hypot(hypot(x, y), z); }
  friend Number atan2(const Number& y, const Number& x) {
    return compose([](auto u, auto w) { return atan2(u, w); }, y, x);
  }
  friend Number fmod(const Number& x, const Number& y) {
    return compose([](auto u, auto w) { return fmod(u, w); }, x, y);
  }
  friend Number remainder(const Number& x, const Number& y) {
    return compose([](auto u, auto w) { return remainder(u, w); }, x, y);
  }

 private:
  template <class Function>
  static Number compose(Function function, const Number& x) {
    Dual<Dual<double, 1>, 1> u = x.value;
    u.value.derivatives[0] = 1;
    u.derivatives[0].value = 1;
    const auto f = function(u);
    return chain(x, f.value.value, f.derivatives[0].value, f.derivatives[0].derivatives[0]);
  }
  template <class Function>
  static Number compose(Function function, const Number& x, const Number& y) {
    Dual<Dual<double, 2>, 2> u = x.value, w = y.value;
    u.value.derivatives[0] = w.value.derivatives[1] = 1;
    u.derivatives[0].value = w.derivatives[1].value = 1;
    const auto f = function(u, w);
    const auto& along_x = f.derivatives[0];
    const auto& along_y = f.derivatives[1];
    return chain(x, y,
                 Partials{f.value.value, along_x.value, along_y.value, along_x.derivatives[0],
                          along_x.derivatives[1], along_y.derivatives[1]});
  }
};

}  // namespace hybrid_sphere::mechanics
