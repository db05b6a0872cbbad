#pragma once

#include <Eigen/Core>
#include <cfloat>
#include <cmath>

#include "geometry/double_double.hpp"

/// Signs that do not depend on rounding: compensated products with a bound on their error, and a hundred
/// digits for the rare case in which the bound does not decide.
namespace hybrid_sphere::exact {

using Eigen::Vector2d;

/// A value with a bound on its absolute error.
struct Bounded {
  double value;
  double error;
  bool has_sign() const { return std::abs(value) > error; }
};

/// a - b without loss, as a rounded value and its remainder.
struct Difference {
  Difference(const Vector2d& a, const Vector2d& b)
      : Difference(two_difference(a.x(), b.x()), two_difference(a.y(), b.y())) {}
  explicit Difference(const Vector2d& a) : value(a), remainder(Vector2d::Zero()) {}

  Difference turned() const {
    return {DoubleDouble{-value.y(), -remainder.y()}, DoubleDouble{value.x(), remainder.x()}};
  }

  Vector2d value;
  Vector2d remainder;

 private:
  Difference(const DoubleDouble& x, const DoubleDouble& y)
      : value(x.value, y.value), remainder(x.remainder, y.remainder) {}
};

/// a b - c d to an ulp or two. Source: Kahan; Jeannerod, Louvet, Muller, Math. Comp. 82 (2013).
inline double difference_of_products(double a, double b, double c, double d) {
  const double cd = c * d;
  return std::fma(a, b, -cd) + std::fma(-c, d, cd);
}

/// p_x q_y - p_y q_x. The bound holds the rounding of the result and the neglected products of second order.
inline Bounded cross(const Difference& p, const Difference& q) {
  const double main = difference_of_products(p.value.x(), q.value.y(), p.value.y(), q.value.x());
  const double correction = p.remainder.x() * q.value.y() + p.value.x() * q.remainder.y() -
                            p.remainder.y() * q.value.x() - p.value.y() * q.remainder.x();
  const double value = main + correction;
  const double size = std::abs(p.value.x() * q.value.y()) + std::abs(p.value.y() * q.value.x());
  return {value, 4 * DBL_EPSILON * std::abs(value) + 16 * DBL_EPSILON * DBL_EPSILON * size + DBL_MIN};
}

/// p_x q_x + p_y q_y.
inline Bounded dot(const Difference& p, const Difference& q) { return cross(p, q.turned()); }

inline int sign(double x) { return (x > 0) - (x < 0); }

/// Sign of cross(v, p - q).
int sign_of_cross(const Vector2d& v, const Vector2d& p, const Vector2d& q);

/// Sign of dot(v, p - q).
int sign_of_dot(const Vector2d& v, const Vector2d& p, const Vector2d& q);

/// Sign of the area of the triangle a, b, c: positive when it runs counter-clockwise.
int orientation(const Vector2d& a, const Vector2d& b, const Vector2d& c);

/// Sign of |p - c|^2 - radius^2: negative inside the circle.
int side_of_circle(const Vector2d& p, const Vector2d& center, double radius);

}  // namespace hybrid_sphere::exact
