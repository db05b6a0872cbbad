#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <type_traits>

#include "hybrid_sphere/mechanics/dual.hpp"

namespace hybrid_sphere::mechanics {

/// A number with the derivatives that Lagrange's equations need, all in one evaluation: along n velocities,
/// along the motion and along n further directions, and the second ones of the velocities among themselves
/// and with the motion. (Hyper-dual numbers, after Fike and Alonso, AIAA 2011-886.)
///
/// It has all operators and functions of Dual, with the same rules.
/// @code
/// mechanics::HyperDual<1> v = 3.0;
/// v.slopes[0] = 1;
/// const mechanics::HyperDual<1> y = v * v;  // 9, y.slopes[0] = 6, y.second(0, 0) = 2
/// @endcode
template <int n>
struct HyperDual {
  static constexpr int motion = n;                ///< index of the derivative along the motion
  static constexpr int first_of_further = n + 1;  ///< index of the first of the n further ones
  static constexpr int directions = 2 * n + 1;
  static constexpr int pairs = n * (n + 3) / 2;

  double value;
  double slopes[std::size_t(directions)];  ///< first derivatives
  double curvatures[std::size_t(pairs)];   ///< second(i, j), a row after another

  HyperDual() : HyperDual(0.0) {}
  /// A constant.
  template <class Number, class = std::enable_if_t<std::is_arithmetic_v<Number>>>
  HyperDual(Number constant) : value(static_cast<double>(constant)), slopes{}, curvatures{} {}

  /// The second derivative along the velocities i and j, or the motion where j is `motion`. @param i  <= j
  double second(int i, int j) const { return curvatures[start(i) + j]; }

  HyperDual& operator+=(const HyperDual& b) { return *this = *this + b; }
  HyperDual& operator-=(const HyperDual& b) { return *this = *this - b; }
  HyperDual& operator*=(const HyperDual& b) { return *this = *this * b; }
  HyperDual& operator/=(const HyperDual& b) { return *this = *this / b; }
  HyperDual& operator+=(double b) { return value += b, *this; }
  HyperDual& operator-=(double b) { return value -= b, *this; }
  HyperDual& operator*=(double b) { return *this = *this * b; }
  HyperDual& operator/=(double b) { return *this = *this / b; }

  friend HyperDual operator+(const HyperDual& a) { return a; }
  friend HyperDual operator-(const HyperDual& a) {
    return each(a, [](double x) { return -x; });
  }
  friend HyperDual operator+(const HyperDual& a, const HyperDual& b) {
    return each(a, b, [](double x, double y) { return x + y; });
  }
  friend HyperDual operator-(const HyperDual& a, const HyperDual& b) {
    return each(a, b, [](double x, double y) { return x - y; });
  }
  friend HyperDual operator*(const HyperDual& a, const HyperDual& b) {
    HyperDual c{Uninitialized()};
    c.value = a.value * b.value;
    for (int i = 0; i < directions; ++i) c.slopes[i] = a.slopes[i] * b.value + a.value * b.slopes[i];
    for (int i = 0; i < n; ++i) {
      for (int j = i; j <= n; ++j) {
        const int k = start(i) + j;
        c.curvatures[k] = a.curvatures[k] * b.value + a.value * b.curvatures[k] + a.slopes[i] * b.slopes[j] +
                          b.slopes[i] * a.slopes[j];
      }
    }
    return c;
  }
  friend HyperDual operator/(const HyperDual& a, const HyperDual& b) {
    HyperDual c{Uninitialized()};
    const double inverse = 1 / b.value;
    c.value = a.value / b.value;
    for (int i = 0; i < directions; ++i) c.slopes[i] = (a.slopes[i] - c.value * b.slopes[i]) * inverse;
    for (int i = 0; i < n; ++i) {
      for (int j = i; j <= n; ++j) {
        const int k = start(i) + j;
        c.curvatures[k] = (a.curvatures[k] - c.value * b.curvatures[k] - c.slopes[i] * b.slopes[j] -
                           b.slopes[i] * c.slopes[j]) *
                          inverse;
      }
    }
    return c;
  }
  friend HyperDual operator+(HyperDual a, double b) { return a.value += b, a; }
  friend HyperDual operator+(double a, const HyperDual& b) { return b + a; }
  friend HyperDual operator-(HyperDual a, double b) { return a.value -= b, a; }
  friend HyperDual operator-(double a, const HyperDual& b) { return -b + a; }
  friend HyperDual operator*(const HyperDual& a, double b) {
    return each(a, [b](double x) { return x * b; });
  }
  friend HyperDual operator*(double a, const HyperDual& b) { return b * a; }
  friend HyperDual operator/(const HyperDual& a, double b) {
    return each(a, [b](double x) { return x / b; });
  }
  friend HyperDual operator/(double a, const HyperDual& b) {
    const double inverse = 1 / b.value;
    const double quotient = a / b.value;
    const double slope = -quotient * inverse;
    return chain(b, quotient, slope, -2 * slope * inverse);
  }

  friend bool operator==(const HyperDual& a, const HyperDual& b) { return a.value == b.value; }
  friend bool operator!=(const HyperDual& a, const HyperDual& b) { return a.value != b.value; }
  friend bool operator<(const HyperDual& a, const HyperDual& b) { return a.value < b.value; }
  friend bool operator>(const HyperDual& a, const HyperDual& b) { return a.value > b.value; }
  friend bool operator<=(const HyperDual& a, const HyperDual& b) { return a.value <= b.value; }
  friend bool operator>=(const HyperDual& a, const HyperDual& b) { return a.value >= b.value; }

  /// f(x). @param value  f @param slope  f' @param curvature  f''
  friend HyperDual chain(const HyperDual& x, double value, double slope, double curvature) {
    HyperDual f{Uninitialized()};
    f.value = value;
    for (int i = 0; i < directions; ++i) f.slopes[i] = slope * x.slopes[i];
    for (int i = 0; i < n; ++i) {
      const double of_row = curvature * x.slopes[i];
      for (int j = i; j <= n; ++j) {
        const int k = start(i) + j;
        f.curvatures[k] = slope * x.curvatures[k] + of_row * x.slopes[j];
      }
    }
    return f;
  }

  friend HyperDual abs(const HyperDual& x) { return x.value < 0.0 ? -x : x; }
  friend HyperDual fabs(const HyperDual& x) { return abs(x); }
  friend HyperDual min(const HyperDual& x, const HyperDual& y) { return y < x ? y : x; }
  friend HyperDual max(const HyperDual& x, const HyperDual& y) { return x < y ? y : x; }
  friend HyperDual fmin(const HyperDual& x, const HyperDual& y) { return min(x, y); }
  friend HyperDual fmax(const HyperDual& x, const HyperDual& y) { return max(x, y); }
  friend HyperDual fdim(const HyperDual& x, const HyperDual& y) { return x > y ? x - y : HyperDual(0.0); }
  /// abs(x) with the sign of y.
  friend HyperDual copysign(const HyperDual& x, const HyperDual& y) {
    return signbit(x) == signbit(y) ? x : -x;
  }

  // Constant between their jumps.
  friend HyperDual floor(const HyperDual& x) { return std::floor(x.value); }
  friend HyperDual ceil(const HyperDual& x) { return std::ceil(x.value); }
  friend HyperDual round(const HyperDual& x) { return std::round(x.value); }
  friend HyperDual trunc(const HyperDual& x) { return std::trunc(x.value); }
  friend HyperDual rint(const HyperDual& x) { return std::rint(x.value); }
  friend HyperDual nearbyint(const HyperDual& x) { return std::nearbyint(x.value); }

  friend bool isfinite(const HyperDual& x) { return std::isfinite(x.value); }
  friend bool isinf(const HyperDual& x) { return std::isinf(x.value); }
  friend bool isnan(const HyperDual& x) { return std::isnan(x.value); }
  friend bool signbit(const HyperDual& x) { return std::signbit(x.value); }

  friend HyperDual sqrt(const HyperDual& x) {
    const double root = std::sqrt(x.value);
    const double slope = 0.5 / root;
    return chain(x, root, slope, -0.5 * slope / x.value);
  }
  friend HyperDual sin(const HyperDual& x) {
    const double sine = std::sin(x.value);
    return chain(x, sine, std::cos(x.value), -sine);
  }
  friend HyperDual cos(const HyperDual& x) {
    const double cosine = std::cos(x.value);
    return chain(x, cosine, -std::sin(x.value), -cosine);
  }
  friend HyperDual exp(const HyperDual& x) {
    const double power = std::exp(x.value);
    return chain(x, power, power, power);
  }
  friend HyperDual fma(const HyperDual& x, const HyperDual& y, const HyperDual& z) { return x * y + z; }

  // Differentiated by Dual.
  friend HyperDual cbrt(const HyperDual& x) {
    return compose([](auto u) { return cbrt(u); }, x);
  }
  friend HyperDual tan(const HyperDual& x) {
    return compose([](auto u) { return tan(u); }, x);
  }
  friend HyperDual asin(const HyperDual& x) {
    return compose([](auto u) { return asin(u); }, x);
  }
  friend HyperDual acos(const HyperDual& x) {
    return compose([](auto u) { return acos(u); }, x);
  }
  friend HyperDual atan(const HyperDual& x) {
    return compose([](auto u) { return atan(u); }, x);
  }
  friend HyperDual sinh(const HyperDual& x) {
    return compose([](auto u) { return sinh(u); }, x);
  }
  friend HyperDual cosh(const HyperDual& x) {
    return compose([](auto u) { return cosh(u); }, x);
  }
  friend HyperDual tanh(const HyperDual& x) {
    return compose([](auto u) { return tanh(u); }, x);
  }
  friend HyperDual asinh(const HyperDual& x) {
    return compose([](auto u) { return asinh(u); }, x);
  }
  friend HyperDual acosh(const HyperDual& x) {
    return compose([](auto u) { return acosh(u); }, x);
  }
  friend HyperDual atanh(const HyperDual& x) {
    return compose([](auto u) { return atanh(u); }, x);
  }
  friend HyperDual expm1(const HyperDual& x) {
    return compose([](auto u) { return expm1(u); }, x);
  }
  friend HyperDual exp2(const HyperDual& x) {
    return compose([](auto u) { return exp2(u); }, x);
  }
  friend HyperDual log(const HyperDual& x) {
    return compose([](auto u) { return log(u); }, x);
  }
  friend HyperDual log2(const HyperDual& x) {
    return compose([](auto u) { return log2(u); }, x);
  }
  friend HyperDual log10(const HyperDual& x) {
    return compose([](auto u) { return log10(u); }, x);
  }
  friend HyperDual log1p(const HyperDual& x) {
    return compose([](auto u) { return log1p(u); }, x);
  }
  friend HyperDual erf(const HyperDual& x) {
    return compose([](auto u) { return erf(u); }, x);
  }
  friend HyperDual erfc(const HyperDual& x) {
    return compose([](auto u) { return erfc(u); }, x);
  }
  friend HyperDual pow(const HyperDual& x, double exponent) {
    return compose([exponent](auto u) { return pow(u, exponent); }, x);
  }
  friend HyperDual pow(double base, const HyperDual& x) {
    return compose([base](auto u) { return pow(base, u); }, x);
  }
  friend HyperDual pow(const HyperDual& x, const HyperDual& exponent) {
    if (is_constant(exponent)) return pow(x, exponent.value);
    return compose([](auto u, auto w) { return pow(u, w); }, x, exponent);
  }
  friend HyperDual hypot(const HyperDual& x, const HyperDual& y) {
    return compose([](auto u, auto w) { return hypot(u, w); }, x, y);
  }
  friend HyperDual hypot(const HyperDual& x, const HyperDual& y, const HyperDual& z) {
    return hypot(hypot(x, y), z);
  }
  friend HyperDual atan2(const HyperDual& y, const HyperDual& x) {
    return compose([](auto u, auto w) { return atan2(u, w); }, y, x);
  }
  friend HyperDual fmod(const HyperDual& x, const HyperDual& y) {
    return compose([](auto u, auto w) { return fmod(u, w); }, x, y);
  }
  friend HyperDual remainder(const HyperDual& x, const HyperDual& y) {
    return compose([](auto u, auto w) { return remainder(u, w); }, x, y);
  }

 private:
  struct Uninitialized {};
  explicit HyperDual(Uninitialized) {}

  /// Where second(i, 0) would be.
  static constexpr int start(int i) { return i * (2 * n + 1 - i) / 2; }

  template <class Operation>
  static HyperDual each(const HyperDual& a, Operation operation) {
    HyperDual c{Uninitialized()};
    c.value = operation(a.value);
    for (int i = 0; i < directions; ++i) c.slopes[i] = operation(a.slopes[i]);
    for (int k = 0; k < pairs; ++k) c.curvatures[k] = operation(a.curvatures[k]);
    return c;
  }
  template <class Operation>
  static HyperDual each(const HyperDual& a, const HyperDual& b, Operation operation) {
    HyperDual c{Uninitialized()};
    c.value = operation(a.value, b.value);
    for (int i = 0; i < directions; ++i) c.slopes[i] = operation(a.slopes[i], b.slopes[i]);
    for (int k = 0; k < pairs; ++k) c.curvatures[k] = operation(a.curvatures[k], b.curvatures[k]);
    return c;
  }

  template <class Function>
  static HyperDual compose(Function function, const HyperDual& x) {
    Dual<Dual<double, 1>, 1> u = x.value;
    u.value.derivatives[0] = 1;
    u.derivatives[0].value = 1;
    const auto f = function(u);
    return chain(x, f.value.value, f.derivatives[0].value, f.derivatives[0].derivatives[0]);
  }
  template <class Function>
  static HyperDual compose(Function function, const HyperDual& x, const HyperDual& y) {
    Dual<Dual<double, 2>, 2> u = x.value, w = y.value;
    u.value.derivatives[0] = w.value.derivatives[1] = 1;
    u.derivatives[0].value = w.derivatives[1].value = 1;
    const auto f = function(u, w);
    const double of_x = f.derivatives[0].value, of_y = f.derivatives[1].value;
    const double xx = f.derivatives[0].derivatives[0], yy = f.derivatives[1].derivatives[1];
    const double xy = f.derivatives[0].derivatives[1];
    HyperDual c{Uninitialized()};
    c.value = f.value.value;
    for (int i = 0; i < directions; ++i) c.slopes[i] = of_x * x.slopes[i] + of_y * y.slopes[i];
    for (int i = 0; i < n; ++i) {
      for (int j = i; j <= n; ++j) {
        const int k = start(i) + j;
        c.curvatures[k] = of_x * x.curvatures[k] + of_y * y.curvatures[k] +
                          x.slopes[i] * (xx * x.slopes[j] + xy * y.slopes[j]) +
                          y.slopes[i] * (xy * x.slopes[j] + yy * y.slopes[j]);
      }
    }
    return c;
  }
};

/// The value of x without derivatives.
template <int n>
double plain(const HyperDual<n>& x) {
  return x.value;
}
/// Whether all derivatives of x are 0.
template <int n>
bool is_constant(const HyperDual<n>& x) {
  const auto is_zero = [](double derivative) { return derivative == 0; };
  return std::all_of(std::begin(x.slopes), std::end(x.slopes), is_zero) &&
         std::all_of(std::begin(x.curvatures), std::end(x.curvatures), is_zero);
}

}  // namespace hybrid_sphere::mechanics

namespace Eigen {

template <int n>
struct NumTraits<hybrid_sphere::mechanics::HyperDual<n>> : NumTraits<double> {
  using Real = hybrid_sphere::mechanics::HyperDual<n>;
  using NonInteger = Real;
  using Nested = Real;
  enum {
    RequireInitialization = 1,
    ReadCost = sizeof(Real) / sizeof(double),
    AddCost = ReadCost,
    MulCost = 3 * ReadCost
  };
};

template <int n, class Operation>
struct ScalarBinaryOpTraits<hybrid_sphere::mechanics::HyperDual<n>, double, Operation> {
  using ReturnType = hybrid_sphere::mechanics::HyperDual<n>;
};
template <int n, class Operation>
struct ScalarBinaryOpTraits<double, hybrid_sphere::mechanics::HyperDual<n>, Operation> {
  using ReturnType = hybrid_sphere::mechanics::HyperDual<n>;
};

}  // namespace Eigen
