#include "mechanics/joint_limit.hpp"

#include <cmath>

namespace hybrid_sphere::mechanics {

void LimitConstraint::fill(const Bodies& bodies, BodyRows& rows) const {
  const AxisMotion motion = bound_.axis->motion(bodies);
  rows.value[0] = bound_.sign * motion.rate;
  rows.gradient.row(0) = bound_.sign * motion.gradient;
  rows.gamma[0] = -bound_.sign * motion.acceleration;
}

void LimitConstraint::position(double /*t*/, const Vector& q, Vector& value) const {
  value.setConstant(1, bound_.gap(bound_.axis->motion(places(q))));
  require_finite(value);
}

double LimitGuard::value(double /*t*/, const Vector& q) const {
  const double gap = bound_.gap(bound_.axis->motion(bound_.axis->at(q)));
  if (!std::isfinite(gap)) throw NotFinite(label_);
  return -gap;
}

double LimitGuard::rate(double /*t*/, const Vector& q, const Vector& q_rate) const {
  const double rate = bound_.axis->motion(bound_.axis->moving(q, q_rate)).rate;
  if (!std::isfinite(rate)) throw NotFinite("derivative of " + label_);
  return -bound_.sign * rate;
}

}  // namespace hybrid_sphere::mechanics
