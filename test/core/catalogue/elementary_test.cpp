// Functions of known motions against fifty digits, where a formula taken literally would lose its own.

#include "catalogue/elementary.hpp"

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <utility>

namespace hybrid_sphere::mechanics::catalogue::elementary_test {
namespace {

using Real = boost::multiprecision::cpp_bin_float_100;

// Some tens of operations on numbers of one size.
constexpr double few = 32 * 0x1p-53;

const double sizes[] = {1e-300, 1e-20, 1e-9, 1e-5, 0.01, 0.3, 0.999, 1.001, 2.5, 30};

TEST(SineGap, KeepsItsDigits) {
  for (const double size : sizes) {
    for (const double s : {size, -size}) {
      const Real x = s;
      // Below 1e-20 the difference is x^3/6 to all digits of a double.
      const Real exact = size < 1e-19 ? Real(x / 6) : Real((x - sin(x)) / (x * x));
      EXPECT_NEAR(sine_gap(s), static_cast<double>(exact), few * std::abs(static_cast<double>(exact))) << s;
    }
  }
  EXPECT_EQ(sine_gap(0), 0);
}

TEST(Arc, IsTheIntegralOfTheDirection) {
  for (const double rate : {0.0, 1e-300, 1e-12, 1e-3, -0.7, 40.0}) {
    for (const double time : {1e-9, 0.3, 5.0}) {
      const double angle = 0.6;
      const Real w = rate, a = angle, t = time;
      const bool straight = std::abs(rate) < 1e-40;
      const Real x = straight ? Real(t * cos(a)) : Real((sin(a + w * t) - sin(a)) / w);
      const Real y = straight ? Real(t * sin(a)) : Real((cos(a) - cos(a + w * t)) / w);
      // The angle itself rounds by units of its size.
      const double allowed = few * time * (1 + std::abs(rate * time));
      EXPECT_NEAR(arc(angle, rate, time).real(), static_cast<double>(x), allowed) << rate << ", " << time;
      EXPECT_NEAR(arc(angle, rate, time).imag(), static_cast<double>(y), allowed) << rate << ", " << time;
    }
  }
}

struct Number {
  Real real, imaginary;
};
Number operator-(const Number& a, const Number& b) { return {a.real - b.real, a.imaginary - b.imaginary}; }
Number operator/(const Number& a, const Number& b) {
  const Real norm = b.real * b.real + b.imaginary * b.imaginary;
  return {(a.real * b.real + a.imaginary * b.imaginary) / norm,
          (a.imaginary * b.real - a.real * b.imaginary) / norm};
}
Number number(const Complex& z) { return {z.real(), z.imag()}; }
Number exact(const Complex& a) {
  const Real growth = exp(Real(a.real()));
  const Number power = {growth * cos(Real(a.imag())), growth * sin(Real(a.imag()))};
  return a == 0.0 ? Number{1, 0} : (power - Number{1, 0}) / number(a);
}

void expect_near(const Complex& value, const Number& exact, double allowed, const Complex& at) {
  EXPECT_NEAR(value.real(), static_cast<double>(exact.real), allowed) << at;
  EXPECT_NEAR(value.imag(), static_cast<double>(exact.imaginary), allowed) << at;
}

TEST(ExpDifference, KeepsItsDigits) {
  for (const double size : sizes) {
    if (size < 1e-40) continue;  // a hundred digits are not enough for the literal formula
    for (const Complex& direction : {Complex(-1, 0), Complex(0, 1), Complex(-0.6, 0.8), Complex(0.6, -0.8)}) {
      const Complex a = size * direction;
      const double magnitude = std::max(1.0, std::exp(a.real()) * (1 + size)) / std::max(1.0, size);
      expect_near(exp_difference(a), exact(a), few * magnitude, a);
    }
  }
  EXPECT_EQ(exp_difference(0.0), 1.0);
}

TEST(ExpDifference, OfThreePointsKeepsItsDigits) {
  for (const double size : sizes) {
    if (size < 1e-40) continue;
    for (const Complex& rate : {Complex(-1, 0), Complex(0, 1), Complex(-0.6, 0.8), Complex(-1e-3, 1)}) {
      // As in explicit_time: exp at 0, 2 i Omega and -gamma + i Omega; at 0, 0 and the latter.
      const Complex b = size * rate, a = {0, 2 * size * rate.imag()};
      for (const Complex& other : {a, Complex(0)}) {
        const Number whole = (exact(other) - exact(b)) / (number(other) - number(b));
        expect_near(exp_difference(other, b), whole, few, b);
      }
    }
  }
  EXPECT_EQ(exp_difference(0.0, 0.0), 0.5);
}

// Against the formulas of its definition in a hundred digits.
TEST(Relaxation, KeepsItsDigits) {
  const double pi = 3.141592653589793;
  for (const double rate : {1e-12, 1e-3, 0.8, 5.0, -0.8, -1e-9}) {
    for (const double time : {1e-6, 0.4, 3.0, 60.0}) {
      for (const double angle : {1e-12, 0.3, -1.2, pi / 2, 2.8, pi - 1e-9}) {
        const double x = 2 * std::cos(angle), y = 2 * std::sin(angle);
        const Relaxation now = Relaxation::from(x, y, rate, time);
        const Real r = rate, start = atan2(Real(y), Real(x));
        const Real then = 2 * atan(tan(start / 2) * exp(-r * time));
        const Real sine_integral = (start - then) / r;
        const Real cosine_integral = -log(sin(then) / sin(start)) / r;
        // exp rounds by units of its exponent.
        const double allowed = few * (1 + std::abs(rate) * time);
        const auto what = [&] { return ::testing::Message() << rate << ", " << time << ", " << angle; };
        EXPECT_NEAR(now.cosine, static_cast<double>(cos(then)), allowed) << what();
        EXPECT_NEAR(now.sine, static_cast<double>(sin(then)), allowed * std::abs(now.sine)) << what();
        EXPECT_NEAR(now.sine_integral, static_cast<double>(sine_integral),
                    allowed * std::abs(now.sine_integral))
            << what();
        EXPECT_NEAR(now.cosine_integral, static_cast<double>(cosine_integral), allowed * time) << what();
      }
    }
  }
}

TEST(Relaxation, StaysWhereNothingMovesIt) {
  const Relaxation up = Relaxation::from(-3, 0, 2, 1e6);
  EXPECT_EQ(up.cosine, -1);
  EXPECT_EQ(up.sine, 0);
  EXPECT_EQ(up.cosine_integral, -1e6);
  const Relaxation down = Relaxation::from(3, 0, -2, 1e6);
  EXPECT_EQ(down.cosine, 1);
  EXPECT_EQ(down.cosine_integral, 1e6);
  const Relaxation free = Relaxation::from(0.6, 0.8, 0, 10);
  EXPECT_NEAR(free.cosine_integral, 6, 10 * few);
  EXPECT_NEAR(free.sine_integral, 8, 10 * few);
  const Relaxation late = Relaxation::from(-1, 1e-3, 1, 1e6);
  EXPECT_EQ(late.sine, 0);
  EXPECT_EQ(late.cosine, 1);
}

TEST(Path, IsTheIntegralToRounding) {
  const auto turning = [](double t) { return std::polar(1.0, 3 * t); };
  const std::optional<Complex> way = path(turning, 100, 4.0 / 3);
  ASSERT_TRUE(way);
  const Complex exact = arc(0, 3, 100);
  // 75 panels, each of the size of its own sum.
  EXPECT_LE(std::abs(*way - exact), 75 * few);
  EXPECT_TRUE(path(turning, 1e4, 1));
  EXPECT_FALSE(path(turning, 1e4 + 1, 1)) << "more than ten thousand panels are given up";
  EXPECT_FALSE(path(turning, 1e9, 1e-3));
  EXPECT_EQ(path(turning, 0, 1), Complex(0));
}

TEST(Path, IsExactForPolynomialsOfDegree59) {
  for (int degree = 0; degree <= 59; ++degree) {
    const std::optional<Complex> integral =
        path([=](double t) { return Complex(std::pow(t, degree)); }, 1, 1);
    ASSERT_TRUE(integral);
    EXPECT_NEAR(integral->real(), 1.0 / (degree + 1), few) << degree;
  }
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::catalogue::elementary_test
