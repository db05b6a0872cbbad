#include "geometry/exact.hpp"

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <optional>

#include "geometry/hundred_digits.hpp"

namespace hybrid_sphere::exact {
namespace {

namespace mp = boost::multiprecision;

/// Every double is an integer in units of 2^-1074; products of two differences of such have 4199 bits.
using Integer =
    mp::number<mp::cpp_int_backend<4224, 4224, mp::signed_magnitude, mp::unchecked, void>, mp::et_off>;

/// The double in units of 2^unit, of which it must be a multiple.
Integer in_units(double x, int unit) {
  if (x == 0) return 0;
  const int exponent = std::ilogb(x) - 52;
  const auto mantissa = static_cast<std::int64_t>(std::ldexp(x, -exponent));
  if (exponent >= unit) return Integer(mantissa) << (exponent - unit);
  return Integer(mantissa) >> (unit - exponent);  // of a denormal: only zeros are lost
}

/// Numbers of which signs are asked for, and whether a hundred digits hold their differences' products.
class Numbers {
 public:
  template <class... Values>
  explicit Numbers(Values... values) {
    (see(values), ...);
  }

  bool fit_in_hundred_digits() const {
    constexpr int spare = 99;  // bits: a factor of 6e29
    return highest_ - lowest_ <= spare;
  }
  /// The largest power of two of which all are multiples, or a smaller one.
  int unit() const { return std::max(lowest_ - 52, -1074); }

 private:
  void see(double x) {
    if (x == 0) return;
    highest_ = std::max(highest_, std::ilogb(x));
    lowest_ = std::min(lowest_, std::ilogb(x));
  }

  int highest_ = -1074;
  int lowest_ = 1024;
};

/// Sign of (a - b) x (c - d).
template <class Number, class Make>
int sign_of_product(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d,
                    const Make& make) {
  const Number ab_x = make(a.x()) - make(b.x());
  const Number ab_y = make(a.y()) - make(b.y());
  const Number cd_x = make(c.x()) - make(d.x());
  const Number cd_y = make(c.y()) - make(d.y());
  const Number left = ab_x * cd_y;
  const Number right = ab_y * cd_x;
  return left.compare(right);
}

int sign_of_difference(double a, double b) { return (a > b) - (a < b); }

/// The sign of the cross product of two differences without remainders; empty if their products may have lost
/// something.
std::optional<int> sign_of_plain_cross(const Difference& p, const Difference& q) {
  constexpr double least = 0x1p-900;  // the remainders of products are normal
  if (!p.remainder.isZero(0) || !q.remainder.isZero(0)) return std::nullopt;
  const DoubleDouble left = two_product(p.value.x(), q.value.y());
  const DoubleDouble right = two_product(p.value.y(), q.value.x());
  for (const double product : {left.value, right.value}) {
    if (!(std::abs(product) >= least && std::abs(product) <= DBL_MAX)) return std::nullopt;
  }
  // Rounding keeps the order.
  if (left.value != right.value) return sign_of_difference(left.value, right.value);
  return sign_of_difference(left.remainder, right.remainder);
}

/// Along the axes the signs of the factors are enough.
int sign_of_cross_exactly(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  const int left = sign_of_difference(a.x(), b.x()) * sign_of_difference(c.y(), d.y());
  const int right = sign_of_difference(a.y(), b.y()) * sign_of_difference(c.x(), d.x());
  if (left != right || left == 0) return sign_of_difference(left, right);
  if (const auto sign = sign_of_plain_cross(Difference(a, b), Difference(c, d))) return *sign;
  const Numbers numbers(a.x(), a.y(), b.x(), b.y(), c.x(), c.y(), d.x(), d.y());
  if (numbers.fit_in_hundred_digits()) {
    return sign_of_product<Real>(a, b, c, d, [](double x) { return Real(x); });
  }
  const int unit = numbers.unit();
  return sign_of_product<Integer>(a, b, c, d, [unit](double x) { return in_units(x, unit); });
}

const Vector2d origin = Vector2d::Zero();

/// Whether a difference of two products has the sign that it shows. Each holds the rounding of a product and
/// of up to two differences, and the difference its own (Shewchuk 1997, ccwerrboundA).
bool decides(double left, double right) {
  constexpr double error = 4 * DBL_EPSILON;
  return std::abs(left - right) > error * (std::abs(left) + std::abs(right)) + DBL_MIN;
}

/// That of a cross product which rounding may hide.
int sign_of_small_cross(const Vector2d& v, const Vector2d& p, const Vector2d& q) {
  if (v.x() == 0) return -sign(v.y()) * sign_of_difference(p.x(), q.x());
  if (v.y() == 0) return sign(v.x()) * sign_of_difference(p.y(), q.y());
  const Bounded c = cross(Difference(v), Difference(p, q));
  return c.has_sign() ? sign(c.value) : sign_of_cross_exactly(v, origin, p, q);
}

}  // namespace

int sign_of_cross(const Vector2d& v, const Vector2d& p, const Vector2d& q) {
  const double left = v.x() * (p.y() - q.y());
  const double right = v.y() * (p.x() - q.x());
  return decides(left, right) ? sign(left - right) : sign_of_small_cross(v, p, q);
}

int sign_of_dot(const Vector2d& v, const Vector2d& p, const Vector2d& q) {
  return sign_of_cross(Vector2d(v.y(), -v.x()), p, q);
}

int orientation(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const double left = (b.x() - a.x()) * (c.y() - a.y());
  const double right = (b.y() - a.y()) * (c.x() - a.x());
  if (decides(left, right)) return sign(left - right);
  const Bounded area = cross(Difference(b, a), Difference(c, a));
  return area.has_sign() ? sign(area.value) : sign_of_cross_exactly(b, a, c, a);
}

int side_of_circle(const Vector2d& p, const Vector2d& center, double radius) {
  const Difference d(p, center);
  const double distance = d.value.norm();
  const double gap = distance - radius;
  const bool squares_are_normal =
      std::min(distance, radius) > 0x1p-511 && std::max(distance, radius) < 0x1p+511;
  if (std::abs(gap) > 8 * DBL_EPSILON * radius && squares_are_normal) return sign(gap);
  const Numbers numbers(p.x(), p.y(), center.x(), center.y(), radius);
  const auto sign_of_height = [&](auto number, const auto& make) {
    using Number = decltype(number);
    const Number x = make(p.x()) - make(center.x());
    const Number y = make(p.y()) - make(center.y());
    const Number r = make(radius);
    const Number square = x * x + y * y;
    return square.compare(r * r);
  };
  if (numbers.fit_in_hundred_digits()) {
    return sign_of_height(Real(), [](double value) { return Real(value); });
  }
  const int unit = numbers.unit();
  return sign_of_height(Integer(), [unit](double value) { return in_units(value, unit); });
}

}  // namespace hybrid_sphere::exact
