#include "hybrid_sphere/geometry/exact.hpp"

#include "hybrid_sphere/geometry/hundred_digits.hpp"

namespace hybrid_sphere::exact {
namespace {

Real cross_exactly(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  return (Real(a.x()) - b.x()) * (Real(c.y()) - d.y()) - (Real(a.y()) - b.y()) * (Real(c.x()) - d.x());
}

const Vector2d origin = Vector2d::Zero();

}  // namespace

int sign_of_cross(const Vector2d& v, const Vector2d& p, const Vector2d& q) {
  const Bounded c = cross(Difference(v), Difference(p, q));
  return c.has_sign() ? sign(c.value) : sign(cross_exactly(v, origin, p, q));
}

int sign_of_dot(const Vector2d& v, const Vector2d& p, const Vector2d& q) {
  return sign_of_cross(Vector2d(v.y(), -v.x()), p, q);
}

int orientation(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const Bounded area = cross(Difference(b, a), Difference(c, a));
  return area.has_sign() ? sign(area.value) : sign(cross_exactly(b, a, c, a));
}

int side_of_circle(const Vector2d& p, const Vector2d& center, double radius) {
  const Difference d(p, center);
  const double distance = d.value.norm();
  const double gap = distance - radius;
  if (std::abs(gap) > 8 * DBL_EPSILON * radius) return sign(gap);
  const Real x = Real(p.x()) - center.x();
  const Real y = Real(p.y()) - center.y();
  return sign(Real(x * x + y * y - Real(radius) * radius));
}

}  // namespace hybrid_sphere::exact
