#include "geometry/exact.hpp"

#include <algorithm>
#include <optional>

#include "geometry/wide_integer.hpp"

namespace hybrid_sphere::exact {
namespace {

/// The numbers of which a sign is wanted, as integers in a unit of which all are multiples.
class Integers {
 public:
  template <class... Values>
  explicit Integers(Values... values) {
    (include(values), ...);
  }

  WideInteger operator()(double x) const { return {x, unit_}; }

 private:
  void include(double x) {
    if (x != 0) unit_ = std::min(unit_, std::max(std::ilogb(x) - 52, -1074));
  }

  int unit_ = 1024;
};

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
  const Integers integer(a.x(), a.y(), b.x(), b.y(), c.x(), c.y(), d.x(), d.y());
  const WideInteger left_product = (integer(a.x()) - integer(b.x())) * (integer(c.y()) - integer(d.y()));
  const WideInteger right_product = (integer(a.y()) - integer(b.y())) * (integer(c.x()) - integer(d.x()));
  return (left_product - right_product).sign();
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
  const Integers integer(p.x(), p.y(), center.x(), center.y(), radius);
  const WideInteger x = integer(p.x()) - integer(center.x());
  const WideInteger y = integer(p.y()) - integer(center.y());
  const WideInteger r = integer(radius);
  return (x * x + y * y - r * r).sign();
}

}  // namespace hybrid_sphere::exact
