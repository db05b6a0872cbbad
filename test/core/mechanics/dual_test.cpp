// Values and derivatives of functions of Duals against closed forms.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "core/mechanics/dual_derivatives.hpp"

namespace hybrid_sphere::mechanics::dual_test {
namespace {

using testing::derivatives, testing::Derivatives, testing::expect_near, testing::Second, testing::tolerance,
    testing::variable;

TEST(Dual, HasTheDerivativesOfRootsAndPowers) {
  const double x = 0.7;
  const Second d = variable(x);
  const double root = std::sqrt(x);
  const double cube_root = std::cbrt(x);
  const double power = std::pow(x, 2.5);
  const double l = std::log(x);
  const double self = std::pow(x, x);
  expect_near(sqrt(d), {root, 0.5 / root, -0.25 / (x * root)}, "sqrt");
  expect_near(cbrt(d), {cube_root, cube_root / (3 * x), -2 * cube_root / (9 * x * x)}, "cbrt");
  expect_near(cbrt(-d), {-cube_root, -cube_root / (3 * x), 2 * cube_root / (9 * x * x)}, "cbrt of -x");
  expect_near(pow(d, 2.5), {power, 2.5 * power / x, 3.75 * power / (x * x)}, "pow(x, 2.5)");
  expect_near(pow(d, -2), {1 / (x * x), -2 / (x * x * x), 6 / (x * x * x * x)}, "pow(x, -2)");
  expect_near(pow(-d, 3), {-x * x * x, -3 * x * x, -6 * x}, "pow(-x, 3)");
  expect_near(pow(-d, 3.0), {-x * x * x, -3 * x * x, -6 * x}, "pow(-x, 3.0)");
  expect_near(pow(-d, Second(3)), {-x * x * x, -3 * x * x, -6 * x}, "pow(-x, Dual 3)");
  expect_near(pow(3.0, d),
              {std::pow(3, x), std::pow(3, x) * std::log(3), std::pow(3, x) * std::log(3) * std::log(3)},
              "pow(3.0, x)");
  expect_near(pow(3, d), derivatives(pow(3.0, d)), "pow(3, x)");
  expect_near(pow(d, d), {self, self * (l + 1), self * ((l + 1) * (l + 1) + 1 / x)}, "pow(x, x)");
  expect_near(hypot(d, 2 * d), {std::sqrt(5) * x, std::sqrt(5), 0}, "hypot(x, 2 x)");
  expect_near(hypot(d, 1.0), {std::hypot(x, 1), x / std::hypot(x, 1), 1 / std::pow(std::hypot(x, 1), 3)},
              "hypot(x, 1)");
}

TEST(Dual, HasTheDerivativesOfExponentialsAndLogarithms) {
  const double x = 0.7;
  const Second d = variable(x);
  const double e = std::exp(x);
  expect_near(exp(d), {e, e, e}, "exp");
  expect_near(expm1(d), {std::expm1(x), e, e}, "expm1");
  expect_near(log(d), {std::log(x), 1 / x, -1 / (x * x)}, "log");
  expect_near(log1p(d), {std::log1p(x), 1 / (1 + x), -1 / ((1 + x) * (1 + x))}, "log1p");
}

TEST(Dual, HasTheDerivativesOfCircularFunctions) {
  const double x = 0.7;
  const Second d = variable(x);
  const double s = std::sin(x);
  const double c = std::cos(x);
  const double t = std::tan(x);
  const double u = 1 - x * x;
  const double w = 1 + x * x;
  expect_near(sin(d), {s, c, -s}, "sin");
  expect_near(cos(d), {c, -s, -c}, "cos");
  expect_near(tan(d), {t, 1 / (c * c), 2 * t / (c * c)}, "tan");
  expect_near(asin(d), {std::asin(x), 1 / std::sqrt(u), x / (u * std::sqrt(u))}, "asin");
  expect_near(acos(d), {std::acos(x), -1 / std::sqrt(u), -x / (u * std::sqrt(u))}, "acos");
  expect_near(atan(d), {std::atan(x), 1 / w, -2 * x / (w * w)}, "atan");
  expect_near(atan2(d, 1.0), {std::atan(x), 1 / w, -2 * x / (w * w)}, "atan2(x, 1)");
  expect_near(atan2(1, d), {std::atan2(1, x), -1 / w, 2 * x / (w * w)}, "atan2(1, x)");
  expect_near(atan2(-d, -1.0), {std::atan2(-x, -1), 1 / w, -2 * x / (w * w)}, "atan2(-x, -1)");
  expect_near(atan2(d, d * d), {std::atan2(1, x), -1 / w, 2 * x / (w * w)}, "atan2(x, x^2)");
}

TEST(Dual, HasTheDerivativesOfHyperbolicFunctions) {
  const double x = 0.7;
  const Second d = variable(x);
  const double s = std::sinh(x);
  const double c = std::cosh(x);
  const double t = std::tanh(x);
  const double w = 1 + x * x;
  const double y = 1.7;
  const double u = y * y - 1;
  expect_near(sinh(d), {s, c, s}, "sinh");
  expect_near(cosh(d), {c, s, c}, "cosh");
  expect_near(tanh(d), {t, 1 / (c * c), -2 * t / (c * c)}, "tanh");
  expect_near(asinh(d), {std::asinh(x), 1 / std::sqrt(w), -x / (w * std::sqrt(w))}, "asinh");
  expect_near(acosh(variable(y)), {std::acosh(y), 1 / std::sqrt(u), -y / (u * std::sqrt(u))}, "acosh");
  expect_near(atanh(d), {std::atanh(x), 1 / (1 - x * x), 2 * x / ((1 - x * x) * (1 - x * x))}, "atanh");
}

TEST(Dual, IsExactAtZero) {
  const Second x = variable(0);
  const double half_pi = std::acos(0);
  const struct {
    const char* name;
    Second f;
    Derivatives expected;
  } cases[] = {{"sin", sin(x), {0, 1, 0}},
               {"cos", cos(x), {1, 0, -1}},
               {"tan", tan(x), {0, 1, 0}},
               {"asin", asin(x), {0, 1, 0}},
               {"acos", acos(x), {half_pi, -1, 0}},
               {"atan", atan(x), {0, 1, 0}},
               {"atan2(x, 2)", atan2(x, 2), {0, 0.5, 0}},
               {"sinh", sinh(x), {0, 1, 0}},
               {"cosh", cosh(x), {1, 0, 1}},
               {"tanh", tanh(x), {0, 1, 0}},
               {"asinh", asinh(x), {0, 1, 0}},
               {"atanh", atanh(x), {0, 1, 0}},
               {"exp", exp(x), {1, 1, 1}},
               {"expm1", expm1(x), {0, 1, 1}},
               {"log1p", log1p(x), {0, 1, -1}},
               {"x x", x * x, {0, 0, 2}},
               {"pow(x, 0)", pow(x, 0), {1, 0, 0}},
               {"pow(x, 1)", pow(x, 1), {0, 1, 0}},
               {"pow(x, 2)", pow(x, 2), {0, 0, 2}},
               {"pow(x, 2.0)", pow(x, 2.0), {0, 0, 2}},
               {"pow(x, Dual 2)", pow(x, Second(2)), {0, 0, 2}},
               {"pow(x, 3)", pow(x, 3), {0, 0, 0}},
               {"pow(x, 4)", pow(x, 4), {0, 0, 0}},
               {"pow(2, x)", pow(2, x), {1, std::log(2), std::log(2) * std::log(2)}},
               {"hypot(x, 2)", hypot(x, 2), {2, 0, 0.5}},
               {"sqrt(x^2 + 4)", sqrt(x * x + 4), {2, 0, 0.5}},
               {"1/(1 + x)", 1 / (1 + x), {1, -1, 2}}};
  for (const auto& c : cases) {
    const Derivatives found = derivatives(c.f);
    EXPECT_EQ(found.value, c.expected.value) << c.name;
    EXPECT_EQ(found.first, c.expected.first) << c.name;
    EXPECT_EQ(found.second, c.expected.second) << c.name;
  }
}

TEST(Dual, SaturatesFarOut) {
  for (const double x : {-400.0, 400.0, 1e300}) {
    const auto [value, first, second] = derivatives(tanh(variable(x)));
    EXPECT_EQ(value, x < 0 ? -1 : 1);
    EXPECT_EQ(first, 0);
    EXPECT_EQ(second, 0);
  }
}

TEST(Dual, IsNotFiniteWhereThereIsNoDerivative) {
  const Second x = variable(0);
  for (const Second& f :
       {sqrt(x), cbrt(x), hypot(x, x), sqrt(x * x), pow(x, 0.5), pow(x, 1.5), atan2(x, x)}) {
    EXPECT_EQ(plain(f), 0);
    EXPECT_FALSE(is_finite(f));
  }
  EXPECT_FALSE(is_finite(log(x)));
  EXPECT_FALSE(is_finite(pow(x, -1)));
  EXPECT_FALSE(is_finite(asin(variable(1))));
  EXPECT_FALSE(is_finite(pow(variable(-1), 0.5)));
  EXPECT_TRUE(is_finite(sqrt(variable(1e-200))));
}

TEST(Dual, TakesTheDerivativeOfTheBranch) {
  const double x = 0.7;
  const Second d = variable(x);
  const Derivatives identity{x, 1, 0};
  expect_near(abs(d), identity, "abs(x)");
  expect_near(abs(-d), identity, "abs(-x)");
  expect_near(fabs(-d), identity, "fabs(-x)");
  expect_near(abs(d * d - 3 * d), {3 * x - x * x, 3 - 2 * x, -2}, "abs(x^2 - 3 x)");
  expect_near(max(d, 0.5), identity, "max(x, 0.5)");
  expect_near(max(1.0, d), {1, 0, 0}, "max(1.0, x)");
  expect_near(max(d, 1), {1, 0, 0}, "max(x, 1)");
  expect_near(min(d, 1), identity, "min(x, 1)");
  expect_near(min(d, d * d), {x * x, 2 * x, 2}, "min(x, x^2)");
  expect_near(std::max(d, Second(0.5)), identity, "std::max");
  expect_near(d > 0 ? d * d : d * 3.0, {x * x, 2 * x, 2}, "x > 0 ? x^2 : 3 x");
  expect_near(d < 0 ? d : 0.0, {0, 0, 0}, "x < 0 ? x : 0.0");
}

TEST(Dual, ComparesValues) {
  const Second x = variable(2);
  const Second y = 2;
  EXPECT_TRUE(x == y && x == 2 && 2.0 == x && x <= y && x >= 2 && 1 < x && x > 1.5 && x != 3 && 3.0 != x);
  EXPECT_FALSE(x != y || x < y || x > 2 || 2.0 < x || x == 3 || x <= 1 || 3 <= x);
  const Second nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(nan == nan || nan < x || nan >= x);
  EXPECT_TRUE(nan != nan);
}

TEST(Dual, CalculatesWithIntegersAndDoubles) {
  const double x = 0.7;
  const Second d = variable(x);
  expect_near(2 * d + d * 3, {5 * x, 5, 0}, "2 x + x 3");
  expect_near(d / 2 + 1 / d + 1 - d, {x / 2 + 1 / x + 1 - x, 0.5 - 1 / (x * x) - 1, 2 / (x * x * x)},
              "x/2 + 1/x + 1 - x");
  expect_near(d * d * 0.5 - (d - 1.0) * 3 + d * d / 4, {0.75 * x * x - 3 * (x - 1), 1.5 * x - 3, 1.5},
              "mixed");
  expect_near((1.0 - d) / (2 + d), {(1 - x) / (2 + x), -3 / ((2 + x) * (2 + x)), 6 / std::pow(2 + x, 3)},
              "(1 - x)/(2 + x)");
  expect_near(-(+d) - 1.5f + 3u, {1.5 - x, -1, 0}, "-x - 1.5 + 3");
  expect_near(d - 2 - (2 - d), {2 * x - 4, 2, 0}, "x - 2 - (2 - x)");
  Second r = d;
  r *= 2;
  r += 1;
  r -= d;
  r /= d;
  expect_near(r, {1 + 1 / x, -1 / (x * x), 2 / (x * x * x)}, "(2 x + 1 - x)/x");
  r = d;
  r += r;
  r *= r;
  expect_near(r, {4 * x * x, 8 * x, 8}, "(x + x)^2");
  const Second& same = r;
  r -= same;
  expect_near(r, {0, 0, 0}, "r - r");
}

TEST(Dual, IsSafeToKeepWithAuto) {
  const double x = 0.7;
  const Second d = variable(x);
  const auto square = [](const auto& a) { return a * a; };
  const auto c = cos(d * 2.0) + 1.0;
  const auto e = c * c - 1.0;
  const auto f = e * d;
  const double cs = std::cos(2 * x) + 1;
  const double ds = -2 * std::sin(2 * x);
  const double d2 = -4 * std::cos(2 * x);
  expect_near(f,
              {(cs * cs - 1) * x, cs * cs - 1 + 2 * cs * ds * x, 4 * cs * ds + 2 * (ds * ds + cs * d2) * x},
              "x ((cos 2x + 1)^2 - 1)");
  const auto g = square(d) * d;
  const auto h = g + square(d);
  expect_near(h, {x * x * x + x * x, 3 * x * x + 2 * x, 6 * x + 2}, "x^3 + x^2");
  const auto branch = d > 0 ? d * d : d * 3.0;
  expect_near(branch, {x * x, 2 * x, 2}, "branch");
}

TEST(Dual, HasMixedSecondDerivatives) {
  using T = Dual<Dual<double, 2>, 2>;
  const double x = 0.7;
  const double y = -1.3;
  T a = x;
  T b = y;
  a.derivatives[0] = 1;
  b.derivatives[1] = 1;
  a.value.derivatives[0] = 1;
  b.value.derivatives[1] = 1;
  const double r2 = x * x + y * y;
  const double r = std::sqrt(r2);
  const double p = std::pow(x, y);
  const double l = std::log(x);
  const struct {
    const char* name;
    T f;
    double fx, fy, fxx, fxy, fyy;
  } cases[] = {
      {"x y", a * b, y, x, 0, 1, 0},
      {"x/y", a / b, 1 / y, -x / (y * y), 0, -1 / (y * y), 2 * x / (y * y * y)},
      {"hypot", hypot(a, b), x / r, y / r, y * y / (r * r2), -x * y / (r * r2), x * x / (r * r2)},
      {"atan2(x, y)", atan2(a, b), y / r2, -x / r2, -2 * x * y / (r2 * r2), (x * x - y * y) / (r2 * r2),
       2 * x * y / (r2 * r2)},
      {"pow", pow(a, b), y * p / x, l * p, y * (y - 1) * p / (x * x), p / x * (1 + y * l), l * l * p}};
  for (const auto& c : cases) {
    const auto& d = c.f.derivatives;
    const double found[] = {d[0].value,          d[1].value,          d[0].derivatives[0],
                            d[0].derivatives[1], d[1].derivatives[0], d[1].derivatives[1]};
    const double expected[] = {c.fx, c.fy, c.fxx, c.fxy, c.fxy, c.fyy};
    for (int i = 0; i < 6; ++i) {
      EXPECT_NEAR(found[i], expected[i], tolerance * (1 + std::abs(expected[i]))) << c.name << ", " << i;
    }
  }
}

TEST(Dual, IsANumberOfEigen) {
  const double x = 0.7;
  const Second d = variable(x);
  Eigen::Matrix<Second, 3, 1> a;
  a << d, d * d, 1;
  Eigen::Matrix3d matrix;
  matrix << 1, 2, 3, 4, 5, 6, 7, 8, 10;
  const Eigen::Vector3d numbers(1, -2, 3);

  const auto dot = a.dot(a);
  expect_near(dot, {x * x + std::pow(x, 4) + 1, 2 * x + 4 * x * x * x, 2 + 12 * x * x}, "dot");
  expect_near(a.squaredNorm(), derivatives(dot), "squaredNorm");
  expect_near(a.norm(), derivatives(sqrt(dot)), "norm");
  expect_near(a.normalized().squaredNorm(), {1, 0, 0}, "normalized");
  expect_near(a.sum(), {x + x * x + 1, 1 + 2 * x, 2}, "sum");
  const Eigen::Matrix<Second, 3, 1> scaled = 2.0 * a + a * 3 - a / 2;
  expect_near(scaled[1], {4.5 * x * x, 9 * x, 9}, "2 a + a 3 - a/2");
  const Eigen::Matrix<Second, 3, 1> product = matrix.cast<Second>() * a;
  expect_near(product[0], {x + 2 * x * x + 3, 1 + 4 * x, 4}, "matrix.cast a");
  const Eigen::Matrix<Second, 3, 1> mixed = matrix * a;
  expect_near(mixed[0], derivatives(product[0]), "matrix a");
  expect_near(numbers.dot(a), {x - 2 * x * x + 3, 1 - 4 * x, -4}, "numbers.dot(a)");
  const Eigen::Matrix<Second, 3, 1> cross = a.cross(numbers.cast<Second>());
  expect_near(cross[0], {3 * x * x + 2, 6 * x, 6}, "cross");
  expect_near(cross[2], {-2 * x - x * x, -2 - 2 * x, -2}, "cross");
  const Eigen::Matrix<Second, 3, 1> sum = a + numbers;
  expect_near(sum[0], {x + 1, 1, 0}, "a + numbers");
  const Eigen::Matrix<Second, 3, 1> sines = a.array().sin();
  expect_near(sines[0], {std::sin(x), std::cos(x), -std::sin(x)}, "array().sin()");
  const Second form = 0.5 * a.dot(matrix.cast<Second>() * a);
  expect_near(form - 0.5 * Second(a.transpose() * matrix.cast<Second>() * a), {0, 0, 0}, "a^T matrix a");
  const Eigen::Quaternion<Second> turn(cos(d / 2), Second(0), Second(0), sin(d / 2));
  const Eigen::Matrix<Second, 3, 1> turned = turn * Eigen::Matrix<Second, 3, 1>(1, 0, 0);
  expect_near(turned[0], {std::cos(x), -std::sin(x), -std::cos(x)}, "quaternion");
  expect_near(turn.toRotationMatrix()(1, 0), {std::sin(x), std::cos(x), -std::sin(x)}, "rotation matrix");
}

TEST(Dual, StartsAtZero) {
  const Second x;
  EXPECT_EQ(plain(x), 0);
  EXPECT_TRUE(is_constant(x));
  EXPECT_FALSE(is_constant(variable(0)));
  EXPECT_FALSE(is_constant(variable(0) * variable(0)));
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::dual_test
