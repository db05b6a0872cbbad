// Functions of cmath beyond the elementary ones, of Duals.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/mechanics/dual_derivatives.hpp"

namespace hybrid_sphere::mechanics::dual_functions_test {
namespace {

using testing::expect_near, testing::Second, testing::variable;

TEST(Dual, HasTheDerivativesOfOtherLogarithmsAndOfTheErrorFunction) {
  const double x = 0.7;
  const Second d = variable(x);
  const double two = std::log(2);
  const double ten = std::log(10);
  const double bell = 2 / std::sqrt(M_PI) * std::exp(-x * x);
  expect_near(exp2(d), {std::exp2(x), two * std::exp2(x), two * two * std::exp2(x)}, "exp2");
  expect_near(log2(d), {std::log2(x), 1 / (x * two), -1 / (x * x * two)}, "log2");
  expect_near(log10(d), {std::log10(x), 1 / (x * ten), -1 / (x * x * ten)}, "log10");
  expect_near(log10(exp(d * ten)), {x, 1, 0}, "log10(10^x)");
  expect_near(erf(d), {std::erf(x), bell, -2 * x * bell}, "erf");
  expect_near(erfc(d), {std::erfc(x), -bell, 2 * x * bell}, "erfc");
  expect_near(erf(d) + erfc(d), {1, 0, 0}, "erf + erfc");
}

TEST(Dual, HasTheDerivativesOfSumsOfProductsAndSquares) {
  const double x = 0.7;
  const Second d = variable(x);
  const double length = std::sqrt(x * x + 13);
  expect_near(hypot(d, 2.0, 3.0), {length, x / length, 13 / (length * length * length)}, "hypot(x, 2, 3)");
  expect_near(fma(d, d, 2.0), {x * x + 2, 2 * x, 2}, "fma(x, x, 2)");
  expect_near(fmax(d, 0.5) + fmin(d, 1.0), {2 * x, 2, 0}, "fmax + fmin");
  expect_near(fdim(d * d, 0.1), {x * x - 0.1, 2 * x, 2}, "fdim(x^2, 0.1)");
  expect_near(fdim(0.1, d), {0, 0, 0}, "fdim(0.1, x)");
}

TEST(Dual, TakesTheSignOfAnother) {
  const double x = 0.7;
  const Second d = variable(x);
  expect_near(copysign(d * d, -d), {-x * x, -2 * x, -2}, "copysign(x^2, -x)");
  expect_near(copysign(-d, 3.0), {x, 1, 0}, "copysign(-x, 3.0)");
  expect_near(copysign(-d, -0.0), {-x, -1, 0}, "copysign(-x, -0.0)");
  expect_near(copysign(2.0, -d), {-2, 0, 0}, "copysign(2.0, -x)");
  EXPECT_TRUE(signbit(-d) && !signbit(d) && signbit(Second(-0.0)));
}

TEST(Dual, IsConstantWhereItIsRounded) {
  for (const double x : {-2.7, -2.5, -0.3, 0.0, 0.3, 1.5, 2.7, 1e300}) {
    const Second d = variable(x);
    expect_near(floor(d), {std::floor(x), 0, 0}, "floor");
    expect_near(ceil(d), {std::ceil(x), 0, 0}, "ceil");
    expect_near(round(d), {std::round(x), 0, 0}, "round");
    expect_near(trunc(d), {std::trunc(x), 0, 0}, "trunc");
    expect_near(rint(d), {std::rint(x), 0, 0}, "rint");
    expect_near(nearbyint(d), {std::nearbyint(x), 0, 0}, "nearbyint");
  }
}

TEST(Dual, HasTheDerivativesOfRestsOfADivision) {
  for (const double x : {-7.3, -0.2, 0.2, 7.3}) {
    const Second d = variable(x);
    const double k = std::trunc(x / 2);
    expect_near(fmod(d, 2.0), {std::fmod(x, 2), 1, 0}, "fmod(x, 2)");
    expect_near(fmod(d * d, 2.0), {std::fmod(x * x, 2), 2 * x, 2}, "fmod(x^2, 2)");
    expect_near(fmod(x, 1.0 + 0.0 * d), {std::fmod(x, 1), 0, 0}, "fmod of a constant");
    expect_near(remainder(d, 2.0), {std::remainder(x, 2), 1, 0}, "remainder(x, 2)");
    // x - (2 + e) k for a small e = d - x, of which the derivative is 1.
    expect_near(fmod(x, 2.0 + (d - x)), {std::fmod(x, 2), -k, 0}, "fmod(x, 2 + e)");
  }
  EXPECT_FALSE(isfinite(fmod(variable(1), 0.0)));
}

TEST(Dual, TellsWhetherItsValueIsFinite) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(isfinite(variable(1)) && !isfinite(variable(infinity)) && !isfinite(variable(NAN)));
  EXPECT_TRUE(isinf(variable(-infinity)) && !isinf(variable(1)) && !isinf(variable(NAN)));
  EXPECT_TRUE(isnan(variable(NAN)) && !isnan(variable(infinity)));
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::dual_functions_test
