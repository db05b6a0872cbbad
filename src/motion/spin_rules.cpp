#include "motion/spin_rules.hpp"

#include <cmath>

namespace hybrid_sphere {
namespace {

struct Magnus {
  Vector3d rotation;  // Theta
  double angle;       // an estimate of the angle turned
};

// Sixth order; Gauss points t + h (1/2 -+ sqrt(15)/10).
Magnus magnus(Motion& motion, double from, double h) {
  constexpr double offset = 0.3872983346207417;  // sqrt(15)/10
  constexpr double slope = 1.2909944487358056;   // sqrt(15)/3
  const double middle = from + 0.5 * h;
  const Vector3d first = motion.angular_velocity(middle - offset * h);
  const Vector3d second = motion.angular_velocity(middle);
  const Vector3d third = motion.angular_velocity(middle + offset * h);
  const Vector3d a1 = h * second;
  const Vector3d a2 = (slope * h) * (third - first);
  const Vector3d a3 = (10.0 / 3 * h) * ((third - second) - (second - first));
  const Vector3d c1 = a1.cross(a2);
  const Vector3d c2 = (-1.0 / 60) * a1.cross(2 * a3 + c1);
  return {a1 + a3 / 12 + (1.0 / 240) * (c1 - 20 * a1 - a3).cross(a2 + c2),
          h / 3 * (first.norm() + second.norm() + third.norm())};
}

/// The small turn from one rotation to the other [rad].
Vector3d between(const Quaterniond& rotation, const Magnus& reference) {
  return 2 * (rotation * exponential(-reference.rotation)).vec();
}

/// q' = (0, omega) q / 2 at q.
Quaterniond rate(const Vector3d& omega, const Quaterniond& q) {
  return Quaterniond(0, 0.5 * omega.x(), 0.5 * omega.y(), 0.5 * omega.z()) * q;
}

Quaterniond sum(const Quaterniond& q, double h, const Quaterniond& slope) {
  return Quaterniond(Eigen::Vector4d(q.coeffs() + h * slope.coeffs()));
}

Quaterniond turn_by_rk4(Motion& motion, double from, double h) {
  const Vector3d middle = motion.angular_velocity(from + 0.5 * h);
  const Quaterniond q = Quaterniond::Identity();
  const Quaterniond first = rate(motion.angular_velocity(from), q);
  const Quaterniond second = rate(middle, sum(q, 0.5 * h, first));
  const Quaterniond third = rate(middle, sum(q, 0.5 * h, second));
  const Quaterniond fourth = rate(motion.angular_velocity(from + h), sum(q, h, third));
  const Eigen::Vector4d slope = first.coeffs() + 2 * (second.coeffs() + third.coeffs()) + fourth.coeffs();
  return Quaterniond(Eigen::Vector4d(q.coeffs() + h / 6 * slope));
}

/// Theta' for the rotation exp(Theta): the inverse of the exponential map's differential, up to the third
/// order.
Vector3d algebra_rate(const Vector3d& theta, const Vector3d& omega) {
  const Vector3d bracket = theta.cross(omega);
  return omega - 0.5 * bracket + theta.cross(bracket) / 12;
}

Quaterniond turn_by_rkmk4(Motion& motion, double from, double h) {
  const Vector3d middle = motion.angular_velocity(from + 0.5 * h);
  const Vector3d first = motion.angular_velocity(from);
  const Vector3d second = algebra_rate(0.5 * h * first, middle);
  const Vector3d third = algebra_rate(0.5 * h * second, middle);
  const Vector3d fourth = algebra_rate(h * third, motion.angular_velocity(from + h));
  return exponential(h / 6 * (first + 2 * (second + third) + fourth));
}

}  // namespace

Quaterniond exponential(const Vector3d& rotation) {
  const double angle = stable_norm(rotation);
  if (angle == 0) return Quaterniond::Identity();
  const double sine = std::sin(0.5 * angle) / angle;
  return {std::cos(0.5 * angle), sine * rotation.x(), sine * rotation.y(), sine * rotation.z()};
}

namespace {

/// @param h  length of the step
Quaterniond turn_by_fixed_step(SpinRule rule, Motion& motion, double from, double h) {
  const Quaterniond q = Quaterniond::Identity();
  switch (rule) {
    case SpinRule::series: break;
    case SpinRule::euler: return sum(q, h, rate(motion.angular_velocity(from), q));
    case SpinRule::rk4: return turn_by_rk4(motion, from, h);
    case SpinRule::midpoint: return exponential(h * motion.angular_velocity(from + 0.5 * h));
    case SpinRule::rkmk4: return turn_by_rkmk4(motion, from, h);
  }
  return q;
}

}  // namespace

Turn turn_over(SpinRule rule, Motion& motion, double from, double until) {
  const double h = until - from;
  const Quaterniond rotation = turn_by_fixed_step(rule, motion, from, h);
  const Magnus reference = magnus(motion, from, h);
  return {rotation, between(rotation.normalized(), reference).norm(), reference.angle};
}

Quaterniond turn_within_step(SpinRule rule, Motion& motion, double from, double until) {
  return turn_by_fixed_step(rule, motion, from, until - from);
}

}  // namespace hybrid_sphere
