#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <iterator>
#include <type_traits>

#include "hybrid_sphere/mechanics/dual.hpp"
#include "hybrid_sphere/mechanics/elementary_functions.hpp"

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
struct HyperDual : ElementaryFunctions<HyperDual<n>> {
  static constexpr int motion = n;                ///< index of the derivative along the motion
  static constexpr int first_of_further = n + 1;  ///< index of the first of the n further ones
  static constexpr int directions = 2 * n + 1;
  static constexpr int pairs = n * (n + 3) / 2;

  double slopes[2 * std::size_t(n) + 1];  ///< first derivatives
  double value;
  double curvatures[std::size_t(n) * (std::size_t(n) + 3) / 2];  ///< second(i, j), a row after another

  HyperDual() : HyperDual(0.0) {}
  /// A constant.
  template <class Number, class = std::enable_if_t<std::is_arithmetic_v<Number>>>
  HyperDual(Number constant) : value(static_cast<double>(constant)) {
    set_zero<directions>(slopes);
    set_zero<pairs>(curvatures);
  }

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
    HyperDual c{Uninitialized()};
    c.value = -a.value;
    for (int i = 0; i < directions; ++i) c.slopes[i] = -a.slopes[i];
    for (int k = 0; k < pairs; ++k) c.curvatures[k] = -a.curvatures[k];
    return c;
  }
  friend HyperDual operator+(const HyperDual& a, const HyperDual& b) {
    HyperDual c{Uninitialized()};
    c.value = a.value + b.value;
    for (int i = 0; i < directions; ++i) c.slopes[i] = a.slopes[i] + b.slopes[i];
    for (int k = 0; k < pairs; ++k) c.curvatures[k] = a.curvatures[k] + b.curvatures[k];
    return c;
  }
  friend HyperDual operator-(const HyperDual& a, const HyperDual& b) {
    HyperDual c{Uninitialized()};
    c.value = a.value - b.value;
    for (int i = 0; i < directions; ++i) c.slopes[i] = a.slopes[i] - b.slopes[i];
    for (int k = 0; k < pairs; ++k) c.curvatures[k] = a.curvatures[k] - b.curvatures[k];
    return c;
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
    HyperDual c{Uninitialized()};
    c.value = a.value * b;
    for (int i = 0; i < directions; ++i) c.slopes[i] = a.slopes[i] * b;
    for (int k = 0; k < pairs; ++k) c.curvatures[k] = a.curvatures[k] * b;
    return c;
  }
  friend HyperDual operator*(double a, const HyperDual& b) { return b * a; }
  friend HyperDual operator/(const HyperDual& a, double b) {
    HyperDual c{Uninitialized()};
    c.value = a.value / b;
    for (int i = 0; i < directions; ++i) c.slopes[i] = a.slopes[i] / b;
    for (int k = 0; k < pairs; ++k) c.curvatures[k] = a.curvatures[k] / b;
    return c;
  }
  friend HyperDual operator/(double a, const HyperDual& b) {
    const double inverse = 1 / b.value;
    const double quotient = a / b.value;
    const double slope = -quotient * inverse;
    return chain(b, quotient, slope, -2 * slope * inverse);
  }

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

  /// f(x, y)
  friend HyperDual chain(const HyperDual& x, const HyperDual& y, const Partials& f) {
    HyperDual c{Uninitialized()};
    c.value = f.value;
    for (int i = 0; i < directions; ++i) c.slopes[i] = f.x * x.slopes[i] + f.y * y.slopes[i];
    for (int i = 0; i < n; ++i) {
      for (int j = i; j <= n; ++j) {
        const int k = start(i) + j;
        c.curvatures[k] = f.x * x.curvatures[k] + f.y * y.curvatures[k] +
                          x.slopes[i] * (f.xx * x.slopes[j] + f.xy * y.slopes[j]) +
                          y.slopes[i] * (f.xy * x.slopes[j] + f.yy * y.slopes[j]);
      }
    }
    return c;
  }

 private:
  struct Uninitialized {};
  explicit HyperDual(Uninitialized) {}

  /// Where second(i, 0) would be.
  static constexpr int start(int i) { return i * (2 * n + 1 - i) / 2; }
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
