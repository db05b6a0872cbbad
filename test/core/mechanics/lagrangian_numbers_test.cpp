// The numbers that differentiate a Lagrangian, HyperDual and TapedNumber, against Dual: functions of x, y and
// constants, composed so that no derivative is zero.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cfloat>
#include <cmath>
#include <string>

#include "hybrid_sphere/mechanics/hyper_dual.hpp"
#include "hybrid_sphere/mechanics/taped_number.hpp"

namespace hybrid_sphere::mechanics::lagrangian_numbers_test {
namespace {

// Not known to the compiler, which rounds a function of a constant otherwise than the library does.
volatile const double x_given = 0.7, y_given = 1.3;
const double x_value = x_given, y_value = y_given;
constexpr double x_rate = -0.4, y_rate = 2.1;  // along the motion

/// A few operations, each exact to some roundings, on numbers of order one.
constexpr double tolerance = 64 * DBL_EPSILON;

void expect_close(double found, double expected, const std::string& name) {
  EXPECT_NEAR(found, expected, tolerance * (1 + std::abs(expected))) << name;
}

/// Calls see(name, f) for functions f(x, y) of all kinds.
template <class See>
void each_function(See see) {
  see("+", [](auto x, auto y) { return x + y * x + 2 + 3.0; });
  see("-", [](auto x, auto y) { return x - y * x - (1 - x) - 2.0 - (-y); });
  see("*", [](auto x, auto y) { return 2 * x * y * 3.0 * x; });
  see("/", [](auto x, auto y) { return x / y / 2 + 3 / (x * y) + (x + 1) / (y * y - x); });
  see("+=", [](auto x, auto y) {
    auto r = x;
    r += y;
    r -= x * y;
    r *= y;
    r /= x;
    r += 1;
    r *= 2.0;
    r -= 0.5;
    r /= 3;
    return r;
  });
  see("sqrt", [](auto x, auto y) { return sqrt(x * y); });
  see("cbrt", [](auto x, auto y) { return cbrt(x * y); });
  see("hypot", [](auto x, auto y) { return hypot(x * y, y) + hypot(x, 2.0) + hypot(x, y, x * y); });
  see("sin", [](auto x, auto y) { return sin(x * y); });
  see("cos", [](auto x, auto y) { return cos(x * y); });
  see("tan", [](auto x, auto y) { return tan(x * y); });
  see("asin", [](auto x, auto y) { return asin(x * y / 2); });
  see("acos", [](auto x, auto y) { return acos(x * y / 2); });
  see("atan", [](auto x, auto y) { return atan(x * y); });
  see("atan2", [](auto x, auto y) { return atan2(x * y, y) + atan2(x, 1.0) + atan2(1, x * y); });
  see("sinh", [](auto x, auto y) { return sinh(x * y); });
  see("cosh", [](auto x, auto y) { return cosh(x * y); });
  see("tanh", [](auto x, auto y) { return tanh(x * y); });
  see("asinh", [](auto x, auto y) { return asinh(x * y); });
  see("acosh", [](auto x, auto y) { return acosh(x * y + 1); });
  see("atanh", [](auto x, auto y) { return atanh(x * y / 2); });
  see("exp", [](auto x, auto y) { return exp(x * y); });
  see("expm1", [](auto x, auto y) { return expm1(x * y); });
  see("exp2", [](auto x, auto y) { return exp2(x * y); });
  see("log", [](auto x, auto y) { return log(x * y); });
  see("log2", [](auto x, auto y) { return log2(x * y); });
  see("log10", [](auto x, auto y) { return log10(x * y); });
  see("log1p", [](auto x, auto y) { return log1p(x * y); });
  see("erf", [](auto x, auto y) { return erf(x * y); });
  see("erfc", [](auto x, auto y) { return erfc(x * y); });
  see("pow", [](auto x, auto y) { return pow(x * y, 2.5) + pow(x, 3) + pow(2.0, x * y) + pow(y, x * y); });
  see("pow of a constant exponent", [](auto x, auto y) { return pow(-x * y, decltype(x)(3)); });
  see("fma", [](auto x, auto y) { return fma(x, y, x * x); });
  see("abs", [](auto x, auto y) { return abs(-x * y) + fabs(x * y); });
  see("min, max", [](auto x, auto y) { return min(x, x * y) + max(y, 0.1) * fmin(y, x) + fmax(x, y) * x; });
  see("fdim", [](auto x, auto y) { return fdim(y * y, x) + fdim(x, y); });
  see("copysign", [](auto x, auto y) { return copysign(x * y, -x) + copysign(y * x, 2.0); });
  see("rounded", [](auto x, auto y) {
    return x * y * (floor(y) + ceil(y) + round(y) + trunc(y) + rint(y) + nearbyint(y));
  });
  see("fmod", [](auto x, auto y) { return fmod(7 * x, y) + fmod(x * y, 0.2); });
  see("remainder", [](auto x, auto y) { return remainder(7 * x, y) + remainder(x * y, 0.2); });
  see("branch", [](auto x, auto y) { return x < y && x != 1 && 0.5 < x ? x * y : x; });
  see("vectors of Eigen", [](auto x, auto y) {
    using T = decltype(x);
    const Eigen::Matrix<T, 3, 1> a(x, y, x * y), b = a.cross(Eigen::Matrix<T, 3, 1>(y, T(1), x));
    const Eigen::Quaternion<T> turn(cos(x / 2), T(0), T(0), sin(x / 2));
    const Eigen::Matrix<T, 3, 1> sum = 2.0 * a + turn * b - a / 2.0;
    return T(sum.dot(a) + sum.norm());
  });
}

TEST(HyperDual, HasTheDerivativesOfDual) {
  each_function([](const std::string& name, auto f) {
    constexpr int motion = 2;
    using Nested = Dual<Dual<double, 3>, 2>;
    const auto nested = [](double value, int direction, double rate) {
      Nested number = value;
      number.derivatives[direction].value = 1;
      number.value.derivatives[direction] = 1;
      number.value.derivatives[motion] = rate;
      return number;
    };
    const Nested expected = f(nested(x_value, 0, x_rate), nested(y_value, 1, y_rate));
    HyperDual<2> x = x_value, y = y_value;
    x.slopes[0] = y.slopes[1] = 1;
    x.slopes[HyperDual<2>::motion] = x_rate;
    y.slopes[HyperDual<2>::motion] = y_rate;
    x.slopes[HyperDual<2>::first_of_further] = 1;
    y.slopes[HyperDual<2>::first_of_further + 1] = 1;
    const HyperDual<2> found = f(x, y);
    EXPECT_EQ(plain(found), plain(expected)) << name;
    for (int i = 0; i < 2; ++i) {
      const Dual<double, 3>& along = expected.derivatives[i];
      expect_close(found.slopes[i], along.value, name);
      EXPECT_EQ(found.slopes[HyperDual<2>::first_of_further + i], found.slopes[i]) << name;
      for (int j = i; j < 2; ++j) expect_close(found.second(i, j), along.derivatives[j], name);
      expect_close(found.second(i, HyperDual<2>::motion), along.derivatives[motion], name);
    }
    expect_close(found.slopes[HyperDual<2>::motion], expected.value.derivatives[motion], name);
  });
}

TEST(HyperDual, IsConstantWithoutDerivatives) {
  HyperDual<2> x = 3;
  EXPECT_TRUE(is_constant(x));
  x.slopes[4] = 1;
  EXPECT_FALSE(is_constant(x));
  x.slopes[4] = 0;
  x.slopes[0] = 1;
  EXPECT_FALSE(is_constant(x * x - x * 6));  // 0 slope, curvature 2
  EXPECT_TRUE(isfinite(x) && !isnan(x) && !isinf(x) && !signbit(x));
}

TEST(TapedNumber, HasTheDerivativesOfDual) {
  Tape tape;
  each_function([&tape](const std::string& name, auto f) {
    constexpr int motion = 2;
    using Forward = Dual<double, 3>;
    const Forward expected =
        f(Forward(x_value, Eigen::Vector3d(1, 0, x_rate)), Forward(y_value, Eigen::Vector3d(0, 1, y_rate)));
    tape.resize(0);
    const TapedNumber x = tape.input(x_value, x_rate), y = tape.input(y_value, y_rate);
    const TapedNumber found = f(x, y);
    EXPECT_EQ(plain(found), plain(expected)) << name;
    expect_close(found.rate, expected.derivatives[motion], name);
    tape.seed(found, 2);
    tape.propagate();
    expect_close(tape.adjoint(x), 2 * expected.derivatives[0], name);
    expect_close(tape.adjoint(y), 2 * expected.derivatives[1], name);
  });
}

TEST(TapedNumber, AddsTheDerivativesOfAllResults) {
  Tape tape;
  const TapedNumber x = tape.input(3, 1), unused = tape.input(5, 1);
  const TapedNumber square = x * x;
  tape.seed(square, 1);
  tape.seed(square, 1);
  tape.seed(x, 10);
  tape.seed(TapedNumber(7), 100);  // a constant adds nothing
  tape.propagate();
  EXPECT_EQ(tape.adjoint(x), 2 * 6 + 10);
  EXPECT_EQ(tape.adjoint(unused), 0);
  EXPECT_TRUE(is_constant(TapedNumber(2) * 3.0 + 1) && !is_constant(x * 0.0));
}

TEST(TapedNumber, ForgetsWhatComesAfterItsInputs) {
  Tape tape;
  const TapedNumber x = tape.input(3, 1);
  const int inputs = tape.size();
  for (int i = 0; i < 3; ++i) {
    tape.seed(x * x * x, 1);
    tape.propagate();
    EXPECT_EQ(tape.adjoint(x), 27);
    tape.resize(inputs);
    EXPECT_EQ(tape.size(), inputs);
  }
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::lagrangian_numbers_test
