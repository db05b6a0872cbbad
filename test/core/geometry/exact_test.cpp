// The predicates against rational arithmetic, on points as close to a tie as binary64 allows.

#include "geometry/exact.hpp"

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_int.hpp>
#include <limits>
#include <random>

#include "support/case_count.hpp"

namespace hybrid_sphere::testing::exact_test {
namespace {

using exact::Vector2d;
using Rational = boost::multiprecision::cpp_rational;

int sign_of(const Rational& x) { return x.sign(); }

Rational cross(const Vector2d& v, const Vector2d& p, const Vector2d& q) {
  return Rational(v.x()) * (Rational(p.y()) - Rational(q.y())) -
         Rational(v.y()) * (Rational(p.x()) - Rational(q.x()));
}

Rational dot(const Vector2d& v, const Vector2d& p, const Vector2d& q) {
  return Rational(v.x()) * (Rational(p.x()) - Rational(q.x())) +
         Rational(v.y()) * (Rational(p.y()) - Rational(q.y()));
}

Rational area(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return (Rational(b.x()) - Rational(a.x())) * (Rational(c.y()) - Rational(a.y())) -
         (Rational(b.y()) - Rational(a.y())) * (Rational(c.x()) - Rational(a.x()));
}

Rational height_over_circle(const Vector2d& p, const Vector2d& c, double radius) {
  const Rational x = Rational(p.x()) - Rational(c.x());
  const Rational y = Rational(p.y()) - Rational(c.y());
  return x * x + y * y - Rational(radius) * Rational(radius);
}

class Adversary {
 public:
  double number(double size) { return std::uniform_real_distribution<double>(-size, size)(engine_); }
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
  Vector2d point(double size) { return {number(size), number(size)}; }
  /// Moves each coordinate by up to two units in the last place.
  Vector2d nudged(Vector2d p) {
    for (int i = 0; i < 2; ++i) {
      for (int steps = integer(-2, 2); steps != 0; steps += steps > 0 ? -1 : 1) {
        p[i] = std::nextafter(p[i], steps > 0 ? HUGE_VAL : -HUGE_VAL);
      }
    }
    return p;
  }
  double scale() { return std::ldexp(1.0, integer(-40, 40)); }

 private:
  std::mt19937_64 engine_{20050615};
};

constexpr int rounds = 3000;

TEST(ExactOrientation, IsThatOfRationalArithmeticNextToCollinear) {
  Adversary adversary;
  int ties = 0;
  for (int i = 0; i < rounds; ++i) {
    const double size = adversary.scale();
    const Vector2d offset = i % 3 == 0 ? adversary.point(1e8 * size) : Vector2d(0, 0);
    const Vector2d a = offset + adversary.point(size);
    const Vector2d b = offset + adversary.point(size);
    const Vector2d c = adversary.nudged(a + adversary.number(2) * (b - a));
    const int expected = sign_of(area(a, b, c));
    ties += expected == 0;
    ASSERT_EQ(exact::orientation(a, b, c), expected)
        << a.transpose() << ", " << b.transpose() << ", " << c.transpose();
  }
  RecordProperty("ties", ties);
}

TEST(ExactOrientation, FindsTiesOfIntegersAtEveryScale) {
  Adversary adversary;
  int ties = 0;
  for (int i = 0; i < rounds; ++i) {
    const double size = adversary.scale();
    const auto corner = [&]() -> Vector2d {
      return Vector2d(adversary.integer(-4, 4), adversary.integer(-4, 4)) * size;
    };
    const Vector2d a = corner();
    const Vector2d b = corner();
    const Vector2d c = corner();
    const int expected = sign_of(area(a, b, c));
    ties += expected == 0;
    ASSERT_EQ(exact::orientation(a, b, c), expected);
  }
  EXPECT_GT(ties, rounds / 20);
}

TEST(ExactSignOfCross, IsThatOfRationalArithmeticNextToParallel) {
  Adversary adversary;
  for (int i = 0; i < rounds; ++i) {
    const Vector2d q = adversary.point(adversary.scale());
    const Vector2d v = adversary.point(adversary.scale());
    const Vector2d p = adversary.nudged(q + adversary.number(1) * adversary.scale() * v);
    ASSERT_EQ(exact::sign_of_cross(v, p, q), sign_of(cross(v, p, q)));
    const Vector2d across(-v.y(), v.x());
    ASSERT_EQ(exact::sign_of_dot(across, p, q), sign_of(dot(across, p, q)));
  }
}

TEST(ExactSideOfCircle, IsThatOfRationalArithmeticNextToTheCircle) {
  Adversary adversary;
  for (int i = 0; i < rounds; ++i) {
    const double radius = adversary.scale() * (1 + std::abs(adversary.number(1)));
    const Vector2d center = adversary.point(i % 2 == 0 ? radius : 1e6 * radius);
    const double angle = adversary.number(4);
    const Vector2d p = adversary.nudged(center + radius * Vector2d(std::cos(angle), std::sin(angle)));
    ASSERT_EQ(exact::side_of_circle(p, center, radius), sign_of(height_over_circle(p, center, radius)));
  }
}

TEST(ExactSideOfCircle, IsZeroOnPythagoreanPointsOnly) {
  for (const Vector2d& p : {Vector2d(3, 4), Vector2d(-4, 3), Vector2d(5, 0), Vector2d(0, -5)}) {
    EXPECT_EQ(exact::side_of_circle(p, Vector2d::Zero(), 5), 0);
    EXPECT_EQ(exact::side_of_circle(p, Vector2d::Zero(), std::nextafter(5.0, 6.0)), -1);
    EXPECT_EQ(exact::side_of_circle(p, Vector2d::Zero(), std::nextafter(5.0, 4.0)), 1);
  }
}

TEST(ExactBounded, HoldsTheErrorOfCrossAndDot) {
  Adversary adversary;
  for (int i = 0; i < rounds; ++i) {
    const Vector2d a = adversary.point(adversary.scale());
    const Vector2d b = adversary.nudged(a);
    const Vector2d c = adversary.point(adversary.scale());
    const Vector2d d = adversary.nudged(Vector2d(c + adversary.number(1) * (b - a)));
    const exact::Bounded bounded = exact::cross(exact::Difference(a, b), exact::Difference(c, d));
    const Rational truth = (Rational(a.x()) - Rational(b.x())) * (Rational(c.y()) - Rational(d.y())) -
                           (Rational(a.y()) - Rational(b.y())) * (Rational(c.x()) - Rational(d.x()));
    const Rational error = abs(Rational(truth - Rational(bounded.value)));
    ASSERT_LE(error, Rational(bounded.error)) << static_cast<double>(error) << " of " << bounded.value;
  }
}

/// A number of any size that binary64 has, denormal ones included; now and then 0.
double any_number(Adversary& adversary) {
  if (adversary.integer(0, 9) == 0) return 0;
  const int odd = 2 * adversary.integer(-(1 << 20), (1 << 20) - 1) + 1;
  return std::ldexp(odd, adversary.integer(-1074, 1000));
}

Vector2d any_point(Adversary& adversary) { return {any_number(adversary), any_number(adversary)}; }

// The rational numbers have thousands of digits.
TEST(ExactSigns, AreThoseOfRationalArithmeticForNumbersOfEverySize) {
  Adversary adversary;
  const int cases = case_count(750);
  int ties = 0;
  for (int i = 0; i < cases; ++i) {
    const Vector2d a = any_point(adversary);
    const Vector2d b = any_point(adversary);
    const Vector2d c = i % 4 == 0 ? Vector2d(b) : any_point(adversary);
    const int turn = sign_of(area(a, b, c));
    ties += turn == 0;
    ASSERT_EQ(exact::orientation(a, b, c), turn)
        << a.transpose() << ", " << b.transpose() << ", " << c.transpose();
    ASSERT_EQ(exact::sign_of_cross(a, b, c), sign_of(cross(a, b, c)));
    ASSERT_EQ(exact::sign_of_dot(a, b, c), sign_of(dot(a, b, c)));
    const double radius = std::abs(any_number(adversary));
    ASSERT_EQ(exact::side_of_circle(a, b, radius), sign_of(height_over_circle(a, b, radius)))
        << a.transpose() << ", " << b.transpose() << ", " << radius;
  }
  EXPECT_LT(ties, cases / 2);
}

// The points lie on one line but for a shift by a number that is smaller by up to 600 decades.
TEST(ExactSigns, SeeWhatIsSmallerByHundredsOfDecades) {
  Adversary adversary;
  for (int i = 0; i < rounds; ++i) {
    const Vector2d way(adversary.integer(-99, 99), adversary.integer(1, 99));
    const double near = std::ldexp(1.0, adversary.integer(-100, 900));
    const double far = std::ldexp(1.0, adversary.integer(-100, 900));
    const double tiny = std::ldexp(adversary.integer(-3, 3), adversary.integer(-1074, -200));
    const Vector2d v = near * way;
    const Vector2d p = far * way;
    const Vector2d q(tiny, 0);
    ASSERT_EQ(exact::sign_of_cross(v, p, q), exact::sign(way.y() * tiny)) << tiny;
    ASSERT_EQ(exact::orientation(q, p, v), sign_of(area(q, p, v))) << tiny;
  }
  for (const double tiny : {1e-20, 1e-40, 1e-100, 1e-320}) {
    EXPECT_EQ(exact::side_of_circle({1e15 + 2, tiny}, {2, 0}, 1e15), 1) << tiny;
    EXPECT_EQ(exact::side_of_circle({3, 4}, {0, tiny}, 5), -1) << tiny;
    EXPECT_EQ(exact::side_of_circle({3, 4}, {0, -tiny}, 5), 1) << tiny;
  }
  EXPECT_EQ(exact::side_of_circle({3, 4}, {0, 0}, 5), 0);
}

}  // namespace
}  // namespace hybrid_sphere::testing::exact_test
