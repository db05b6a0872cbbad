#pragma once

#include <cstddef>

#include "hybrid_sphere/mechanics/elementary_functions.hpp"

/// Arithmetic of numbers with derivatives whose count is known at run time only. The rules are those of
/// mechanics::HyperDual.
namespace hybrid_sphere::python {

/// How many derivatives a number has: first ones along so many directions, second ones among the `second`
/// foremost.
struct NumberShape {
  int slopes = 0;
  int second = 0;

  bool is_constant() const { return slopes == 0; }
  std::size_t size() const {
    const auto rows = static_cast<std::size_t>(second);
    return 1 + static_cast<std::size_t>(slopes) + rows * (rows + 1) / 2;
  }
  /// Where d2/dx_i dx_j is, j <= i.
  std::size_t place(int i, int j) const {
    const auto row = static_cast<std::size_t>(i);
    return 1 + static_cast<std::size_t>(slopes) + row * (row + 1) / 2 + static_cast<std::size_t>(j);
  }
};
inline bool operator==(const NumberShape& a, const NumberShape& b) {
  return a.slopes == b.slopes && a.second == b.second;
}

/// A number that lies elsewhere: its value, its slopes, and the lower half of the second derivatives by rows.
struct NumberView {
  NumberShape shape;
  const double* data;

  double value() const { return data[0]; }
  double slope(int i) const { return data[1 + i]; }
  double second(int i, int j) const { return data[j <= i ? shape.place(i, j) : shape.place(j, i)]; }
};

/// A function and its derivatives at a place, by the functions of mechanics::ElementaryFunctions.
struct Taylor : mechanics::ElementaryFunctions<Taylor> {
  double value = 0;
  mechanics::Partials f{};  ///< of the result

  Taylor() = default;
  Taylor(double number) : value(number) { f.value = number; }

  friend bool is_constant(const Taylor& /*x*/) { return false; }
  friend Taylor chain(const Taylor& /*x*/, double value, double slope, double curvature) {
    Taylor result = value;
    result.f = {value, slope, 0, curvature, 0, 0};
    return result;
  }
  friend Taylor chain(const Taylor& /*x*/, const Taylor& /*y*/, const mechanics::Partials& f) {
    Taylor result = f.value;
    result.f = f;
    return result;
  }
};

/// f(x) into `result`, of the shape of x. @param f  f.value, f.x and f.xx
void compose(const mechanics::Partials& f, const NumberView& x, double* result);

/// f(x, y) into `result`, of the shape of both.
void compose(const mechanics::Partials& f, const NumberView& x, const NumberView& y, double* result);

/// a x + b y, or a x + b, with the value given.
void combine(double value, double a, const NumberView& x, double b, const NumberView& y, double* result);
void scale(double value, double a, const NumberView& x, double* result);

/// x^e, and its derivatives. x^0 is 1 and x^1 is x for every x; those of x^2, x^3, ... are exact at 0.
mechanics::Partials power(double x, double exponent);
mechanics::Partials power_of_base(double base, double x);
mechanics::Partials power_of_both(double x, double y);

}  // namespace hybrid_sphere::python
