#include "motion/edge_slide.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace hybrid_sphere {

EdgeSlide::EdgeSlide(const Dynamics& dynamics, const Vector2d& first, const Vector2d& second,
                     const Vector2d& normal, const Vector2d& position, const Vector2d& conserved_velocity,
                     const NormalSpin& normal_spin)
    : normal_spin_(normal_spin), radius_(dynamics.radius), start_(position) {
  const Vector2d tangent = turned(normal);
  const double across = conserved_velocity.dot(normal);
  const double push = dynamics.rolling().dot(normal);
  // Speeds across the edge that each ground alone would give.
  const double of_first = across + dynamics.kappa * first.dot(normal);
  const double of_second = across + dynamics.kappa * second.dot(normal);
  const Vector2d between = first - second;
  const double difference = dynamics.kappa * between.dot(normal);  // < 0
  share_ = std::clamp(-of_second / difference, 0.0, 1.0);
  share_rate_ = -push / difference;
  if (push != 0) end_ = std::max(0.0, -(push > 0 ? of_first : of_second) / push);
  // From the nearer ground.
  contact_velocity_ = share_ < 0.5 ? Vector2d(second + share_ * between)
                                   : Vector2d(first - std::min(1.0, of_first / difference) * between);
  contact_acceleration_ = share_rate_ * between;
  const double speed = (conserved_velocity + dynamics.kappa * contact_velocity_).dot(tangent);
  const double fast = conserved_velocity.norm() + contact_velocity_.norm();
  if (std::abs(speed) > 32 * DBL_EPSILON * fast) velocity_ = speed * tangent;
  acceleration_ = (dynamics.rolling() + dynamics.kappa * contact_acceleration_).dot(tangent) * tangent;
}

MotionState EdgeSlide::at(double tau) {
  MotionState state;
  state.center = {start_ + tau * (velocity_ + 0.5 * tau * acceleration_), velocity_ + tau * acceleration_,
                  acceleration_};
  state.contact_velocity = contact_velocity_ + tau * contact_acceleration_;
  const Vector2d nu = state.center.velocity - state.contact_velocity;
  state.angular_velocity = {(0 - nu.y()) / radius_, nu.x() / radius_, normal_spin_.at(tau)};
  return state;
}

int EdgeSlide::expand_spin(double middle, double half, polynomials::Powers<3>& powers) {
  const Vector2d rate = acceleration_ - contact_acceleration_;
  const double normal = normal_spin_.derivative(middle);
  return expand_linear_spin(at(middle).angular_velocity, {-rate.y() / radius_, rate.x() / radius_, normal},
                            half, powers);
}

double EdgeSlide::acceleration_bound(double /*from*/, double /*until*/) {
  return acceleration_.norm() * (1 + 0x1p-50);
}

double EdgeSlide::acceleration_bound_along(const Vector2d& direction, double /*from*/, double /*until*/) {
  return std::abs(acceleration_.dot(direction)) + 0x1p-50 * acceleration_.norm() * direction.norm();
}

Curve EdgeSlide::curve() const {
  Curve curve;
  curve.form = CurveForm::parabola;
  curve.start = start_;
  curve.velocity = velocity_;
  curve.acceleration = acceleration_;
  curve.line = velocity_.isZero(0) ? acceleration_ : velocity_;
  return curve;
}

bool EdgeSlide::steady() const { return normal_spin_.constant() && acceleration_ == contact_acceleration_; }

SpinProfile EdgeSlide::spin_profile() const {
  SpinProfile profile;
  profile.end = end_;
  profile.constant = steady();
  profile.linear = true;
  return profile;
}

}  // namespace hybrid_sphere
