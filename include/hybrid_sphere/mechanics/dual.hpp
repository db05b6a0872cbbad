#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <type_traits>

namespace hybrid_sphere::mechanics {

template <class S, int k>
struct Dual;

/// Sets all numbers to 0, in pairs: GCC makes a `rep stos` of a plain loop, which takes longer to begin than
/// a few stores to run.
template <int count>
void set_zero(double (&numbers)[std::size_t(count)]) {
  for (int i = 0; i + 1 < count; i += 2) numbers[i] = numbers[i + 1] = 0;
  if (count % 2 == 1) numbers[count - 1] = 0;
}

inline double plain(double x) { return x; }
/// The value of x without derivatives.
template <class S, int k>
double plain(const Dual<S, k>& x) {
  return plain(x.value);
}

/// A number with its derivatives in k directions: a function of such numbers returns its value and its exact
/// derivatives (forward mode). S is double, or itself a Dual for derivatives of derivatives.
///
/// All operators and the `cmath` functions below return a Dual, never an expression that refers to other
/// objects, so `auto` is safe. Comparisons compare values; at a kink abs, min and max take the derivative of
/// the branch they return. A function that is not differentiable at its argument (sqrt at 0) gives a
/// derivative that is not finite.
/// @code
/// using mechanics::Dual;
/// const Dual<double, 1> x(3.0, Eigen::Matrix<double, 1, 1>(1.0));
/// const Dual<double, 1> y = x * x;  // 9, and the derivative 6
/// @endcode
template <class S, int k>
struct Dual {
  // The array first: then a copy stores the pairs of numbers that the loops load.
  S derivatives[std::size_t(k)];
  S value;

  Dual() : Dual(0.0) {}
  /// A constant.
  template <class Number, class = std::enable_if_t<std::is_arithmetic_v<Number>>>
  Dual(Number constant) : value(static_cast<double>(constant)) {
    if constexpr (std::is_same_v<S, double>) set_zero<k>(derivatives);
  }
  /// @param dx  the derivatives of x, a vector (k)
  template <class Derivatives>
  Dual(const S& x, const Eigen::MatrixBase<Derivatives>& dx) : value(x) {
    static_assert(Derivatives::SizeAtCompileTime == k, "wrong size: as many derivatives as directions");
    for (int i = 0; i < k; ++i) derivatives[i] = dx[i];
  }

  Dual& operator+=(const Dual& b) { return *this = *this + b; }
  Dual& operator-=(const Dual& b) { return *this = *this - b; }
  Dual& operator*=(const Dual& b) { return *this = *this * b; }
  Dual& operator/=(const Dual& b) { return *this = *this / b; }
  Dual& operator+=(double b) { return *this = *this + b; }
  Dual& operator-=(double b) { return *this = *this - b; }
  Dual& operator*=(double b) { return *this = *this * b; }
  Dual& operator/=(double b) { return *this = *this / b; }

  friend Dual operator+(const Dual& a) { return a; }
  friend Dual operator-(const Dual& a) {
    Dual c{Uninitialized()};
    c.value = -a.value;
    for (int i = 0; i < k; ++i) c.derivatives[i] = -a.derivatives[i];
    return c;
  }
  friend Dual operator+(const Dual& a, const Dual& b) {
    Dual c{Uninitialized()};
    c.value = a.value + b.value;
    for (int i = 0; i < k; ++i) c.derivatives[i] = a.derivatives[i] + b.derivatives[i];
    return c;
  }
  friend Dual operator-(const Dual& a, const Dual& b) {
    Dual c{Uninitialized()};
    c.value = a.value - b.value;
    for (int i = 0; i < k; ++i) c.derivatives[i] = a.derivatives[i] - b.derivatives[i];
    return c;
  }
  friend Dual operator*(const Dual& a, const Dual& b) {
    return chain(a, b, a.value * b.value, b.value, a.value);
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    Dual c{Uninitialized()};
    c.value = a.value / b.value;
    const S inverse = 1.0 / b.value;
    for (int i = 0; i < k; ++i) c.derivatives[i] = (a.derivatives[i] - c.value * b.derivatives[i]) * inverse;
    return c;
  }
  friend Dual operator+(Dual a, double b) { return a.value = a.value + b, a; }
  friend Dual operator+(double a, const Dual& b) { return b + a; }
  friend Dual operator-(Dual a, double b) { return a.value = a.value - b, a; }
  friend Dual operator-(double a, const Dual& b) { return -b + a; }
  friend Dual operator*(const Dual& a, double b) {
    Dual c{Uninitialized()};
    c.value = a.value * b;
    for (int i = 0; i < k; ++i) c.derivatives[i] = a.derivatives[i] * b;
    return c;
  }
  friend Dual operator*(double a, const Dual& b) { return b * a; }
  friend Dual operator/(const Dual& a, double b) {
    Dual c{Uninitialized()};
    c.value = a.value / b;
    for (int i = 0; i < k; ++i) c.derivatives[i] = a.derivatives[i] / b;
    return c;
  }
  friend Dual operator/(double a, const Dual& b) {
    const S quotient = a / b.value;
    return chain(b, quotient, -quotient / b.value);
  }

  friend bool operator==(const Dual& a, const Dual& b) { return a.value == b.value; }
  friend bool operator!=(const Dual& a, const Dual& b) { return a.value != b.value; }
  friend bool operator<(const Dual& a, const Dual& b) { return a.value < b.value; }
  friend bool operator>(const Dual& a, const Dual& b) { return a.value > b.value; }
  friend bool operator<=(const Dual& a, const Dual& b) { return a.value <= b.value; }
  friend bool operator>=(const Dual& a, const Dual& b) { return a.value >= b.value; }

  /// f(x). @param value  f @param slope  f'
  friend Dual chain(const Dual& x, const S& value, const S& slope) {
    Dual f{Uninitialized()};
    f.value = value;
    for (int i = 0; i < k; ++i) f.derivatives[i] = slope * x.derivatives[i];
    return f;
  }
  /// f(x, y). @param value  f @param slope_x  df/dx @param slope_y  df/dy
  friend Dual chain(const Dual& x, const Dual& y, const S& value, const S& slope_x, const S& slope_y) {
    Dual f{Uninitialized()};
    f.value = value;
    for (int i = 0; i < k; ++i) f.derivatives[i] = slope_x * x.derivatives[i] + slope_y * y.derivatives[i];
    return f;
  }

  friend Dual abs(const Dual& x) { return x.value < 0.0 ? -x : x; }
  friend Dual fabs(const Dual& x) { return abs(x); }
  friend Dual min(const Dual& x, const Dual& y) { return y < x ? y : x; }
  friend Dual max(const Dual& x, const Dual& y) { return x < y ? y : x; }
  friend Dual fmin(const Dual& x, const Dual& y) { return min(x, y); }
  friend Dual fmax(const Dual& x, const Dual& y) { return max(x, y); }
  friend Dual fdim(const Dual& x, const Dual& y) { return x > y ? x - y : Dual(0.0); }
  /// abs(x) with the sign of y.
  friend Dual copysign(const Dual& x, const Dual& y) { return signbit(x) == signbit(y) ? x : -x; }

  // Constant between their jumps.
  friend Dual floor(const Dual& x) { return std::floor(plain(x)); }
  friend Dual ceil(const Dual& x) { return std::ceil(plain(x)); }
  friend Dual round(const Dual& x) { return std::round(plain(x)); }
  friend Dual trunc(const Dual& x) { return std::trunc(plain(x)); }
  friend Dual rint(const Dual& x) { return std::rint(plain(x)); }
  friend Dual nearbyint(const Dual& x) { return std::nearbyint(plain(x)); }
  /// x - y trunc(x / y), the quotient taken for a constant.
  friend Dual fmod(const Dual& x, const Dual& y) {
    using std::fmod;
    return rest(x, y, fmod(x.value, y.value));
  }
  /// x - y rint(x / y), the quotient taken for a constant.
  friend Dual remainder(const Dual& x, const Dual& y) {
    using std::remainder;
    return rest(x, y, remainder(x.value, y.value));
  }
  /// x - y k for a whole k that does not vary. @param value  of it
  friend Dual rest(const Dual& x, const Dual& y, const S& value) {
    const double quotient = std::rint((plain(x) - plain(value)) / plain(y));
    return chain(x, y, value, S(1.0), S(-quotient));
  }

  friend bool isfinite(const Dual& x) { return std::isfinite(plain(x)); }
  friend bool isinf(const Dual& x) { return std::isinf(plain(x)); }
  friend bool isnan(const Dual& x) { return std::isnan(plain(x)); }
  friend bool signbit(const Dual& x) { return std::signbit(plain(x)); }

  friend Dual sqrt(const Dual& x) {
    using std::sqrt;
    const S root = sqrt(x.value);
    return chain(x, root, 0.5 / root);
  }
  friend Dual cbrt(const Dual& x) {
    using std::cbrt;
    const S root = cbrt(x.value);
    return chain(x, root, 1.0 / (3.0 * root * root));
  }
  friend Dual hypot(const Dual& x, const Dual& y) {
    using std::hypot;
    const S length = hypot(x.value, y.value);
    return chain(x, y, length, x.value / length, y.value / length);
  }
  friend Dual hypot(const Dual& x, const Dual& y, const Dual& z) { return hypot(hypot(x, y), z); }
  friend Dual fma(const Dual& x, const Dual& y, const Dual& z) { return x * y + z; }

  friend Dual sin(const Dual& x) {
    using std::cos, std::sin;
    return chain(x, sin(x.value), cos(x.value));
  }
  friend Dual cos(const Dual& x) {
    using std::cos, std::sin;
    return chain(x, cos(x.value), -sin(x.value));
  }
  friend Dual tan(const Dual& x) {
    using std::tan;
    const S tangent = tan(x.value);
    return chain(x, tangent, 1.0 + tangent * tangent);
  }
  friend Dual asin(const Dual& x) {
    using std::asin, std::sqrt;
    return chain(x, asin(x.value), 1.0 / sqrt((1.0 - x.value) * (1.0 + x.value)));
  }
  friend Dual acos(const Dual& x) {
    using std::acos, std::sqrt;
    return chain(x, acos(x.value), -1.0 / sqrt((1.0 - x.value) * (1.0 + x.value)));
  }
  friend Dual atan(const Dual& x) {
    using std::atan;
    return chain(x, atan(x.value), 1.0 / (1.0 + x.value * x.value));
  }
  friend Dual atan2(const Dual& y, const Dual& x) {
    using std::atan2;
    const S square = x.value * x.value + y.value * y.value;
    return chain(y, x, atan2(y.value, x.value), x.value / square, -y.value / square);
  }

  friend Dual sinh(const Dual& x) {
    using std::cosh, std::sinh;
    return chain(x, sinh(x.value), cosh(x.value));
  }
  friend Dual cosh(const Dual& x) {
    using std::cosh, std::sinh;
    return chain(x, cosh(x.value), sinh(x.value));
  }
  friend Dual tanh(const Dual& x) {
    using std::tanh;
    const S tangent = tanh(x.value);
    return chain(x, tangent, 1.0 - tangent * tangent);
  }
  friend Dual asinh(const Dual& x) {
    using std::asinh, std::sqrt;
    return chain(x, asinh(x.value), 1.0 / sqrt(1.0 + x.value * x.value));
  }
  friend Dual acosh(const Dual& x) {
    using std::acosh, std::sqrt;
    return chain(x, acosh(x.value), 1.0 / sqrt((x.value - 1.0) * (x.value + 1.0)));
  }
  friend Dual atanh(const Dual& x) {
    using std::atanh;
    return chain(x, atanh(x.value), 1.0 / ((1.0 - x.value) * (1.0 + x.value)));
  }

  friend Dual exp(const Dual& x) {
    using std::exp;
    const S power = exp(x.value);
    return chain(x, power, power);
  }
  friend Dual expm1(const Dual& x) {
    using std::exp, std::expm1;
    return chain(x, expm1(x.value), exp(x.value));
  }
  friend Dual log(const Dual& x) {
    using std::log;
    return chain(x, log(x.value), 1.0 / x.value);
  }
  friend Dual exp2(const Dual& x) {
    using std::exp2;
    const S power = exp2(x.value);
    return chain(x, power, ln_2 * power);
  }
  friend Dual log2(const Dual& x) {
    using std::log2;
    return chain(x, log2(x.value), 1.0 / (ln_2 * x.value));
  }
  friend Dual log10(const Dual& x) {
    using std::log10;
    return chain(x, log10(x.value), 1.0 / (ln_10 * x.value));
  }
  friend Dual erf(const Dual& x) {
    using std::erf;
    return chain(x, erf(x.value), bell(x.value));
  }
  friend Dual erfc(const Dual& x) {
    using std::erfc;
    return chain(x, erfc(x.value), -bell(x.value));
  }
  friend Dual log1p(const Dual& x) {
    using std::log1p;
    return chain(x, log1p(x.value), 1.0 / (1.0 + x.value));
  }
  /// x^0 is 1 and x^1 is x for every x; the derivatives of x^2, x^3, ... are exact at x = 0.
  friend Dual pow(const Dual& x, double exponent) {
    using std::pow;
    if (exponent == 0) return Dual(1.0);
    return chain(x, pow(x.value, exponent), exponent * pow(x.value, exponent - 1));
  }
  friend Dual pow(double base, const Dual& x) {
    using std::pow;
    const S power = pow(base, x.value);
    return chain(x, power, std::log(base) * power);
  }
  friend Dual pow(const Dual& x, const Dual& exponent) {
    using std::log, std::pow;
    if (is_constant(exponent)) return pow(x, plain(exponent));
    const S power = pow(x.value, exponent.value);
    return chain(x, exponent, power, exponent.value * pow(x.value, exponent.value - 1.0),
                 log(x.value) * power);
  }

 private:
  struct Uninitialized {};
  explicit Dual(Uninitialized) {}

  static constexpr double ln_2 = 0.69314718055994530942;
  static constexpr double ln_10 = 2.30258509299404568402;

  /// The derivative of erf.
  static S bell(const S& x) {
    using std::exp;
    constexpr double two_by_root_pi = 1.12837916709551257390;
    return two_by_root_pi * exp(-(x * x));
  }
};

inline bool is_constant(double) { return true; }
/// Whether all derivatives of x are 0.
template <class S, int k>
bool is_constant(const Dual<S, k>& x) {
  const auto vanishes = [](const S& derivative) { return derivative == 0.0 && is_constant(derivative); };
  return is_constant(x.value) && std::all_of(std::begin(x.derivatives), std::end(x.derivatives), vanishes);
}

inline bool is_finite(double x) { return std::isfinite(x); }
/// Whether the value of x and all its derivatives are finite.
template <class S, int k>
bool is_finite(const Dual<S, k>& x) {
  const auto finite = [](const S& derivative) { return is_finite(derivative); };
  return is_finite(x.value) && std::all_of(std::begin(x.derivatives), std::end(x.derivatives), finite);
}

}  // namespace hybrid_sphere::mechanics

namespace Eigen {

template <class S, int k>
struct NumTraits<hybrid_sphere::mechanics::Dual<S, k>> : NumTraits<double> {
  using Real = hybrid_sphere::mechanics::Dual<S, k>;
  using NonInteger = Real;
  using Nested = Real;
  enum {
    RequireInitialization = 1,
    ReadCost = 1 + k,
    AddCost = (1 + k) * static_cast<int>(NumTraits<S>::AddCost),
    MulCost = (1 + 2 * k) * static_cast<int>(NumTraits<S>::MulCost)
  };
};

template <class S, int k, class Operation>
struct ScalarBinaryOpTraits<hybrid_sphere::mechanics::Dual<S, k>, double, Operation> {
  using ReturnType = hybrid_sphere::mechanics::Dual<S, k>;
};
template <class S, int k, class Operation>
struct ScalarBinaryOpTraits<double, hybrid_sphere::mechanics::Dual<S, k>, Operation> {
  using ReturnType = hybrid_sphere::mechanics::Dual<S, k>;
};

}  // namespace Eigen
