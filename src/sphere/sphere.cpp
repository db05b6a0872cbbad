#include "hybrid_sphere/sphere/sphere.hpp"

#include <cmath>

namespace hybrid_sphere {
Sphere::Sphere(const scene::SphereBody& body)
    : mass_(body.mass),
      radius_(body.radius),
      gyration_radius_(body.gyration_radius),
      kappa_(1 / (1 + (radius_ / gyration_radius_) * (radius_ / gyration_radius_))) {}

Vector2d Sphere::contact_velocity(const Twist& twist) const {
  return {std::fma(-radius_, twist.angular_velocity.y(), twist.velocity.x()),
          std::fma(radius_, twist.angular_velocity.x(), twist.velocity.y())};
}

Vector2d Sphere::conserved_velocity(const Twist& twist) const {
  // k^2/R and D/R instead of k^2 and D: no intermediate result is smaller or larger than the data demand.
  const double lever = gyration_radius_ * (gyration_radius_ / radius_);
  const double share = 1 + lever / radius_;
  return {std::fma(lever, twist.angular_velocity.y(), twist.velocity.x()) / share,
          std::fma(-lever, twist.angular_velocity.x(), twist.velocity.y()) / share};
}

double Sphere::kinetic_energy(const Twist& twist) const {
  const double k = gyration_radius_;
  return 0.5 * mass_ * (twist.velocity.squaredNorm() + (k * twist.angular_velocity).squaredNorm());
}

Twist Sphere::rolling_twist(const Vector2d& conserved_velocity, const Vector2d& ground_velocity,
                            double omega_3) const {
  const Vector2d velocity = conserved_velocity + kappa_ * ground_velocity;
  // R (omega_2, -omega_1) = v - u = p_c - (1 - kappa) u
  const Vector2d nu = conserved_velocity - (1 - kappa_) * ground_velocity;
  return {velocity, Vector3d((0 - nu.y()) / radius_, nu.x() / radius_, omega_3)};
}

Vector2d Sphere::stopping_impulse(const Vector2d& slip) const {
  // 0 - x rather than -x: no impulse is 0, not -0.
  return Vector2d::Zero() - mass_ * kappa_ * slip;
}

Vector3d Sphere::angular_impulse(const Vector2d& impulse) const {
  return {radius_ * impulse.y(), 0 - radius_ * impulse.x(), 0};
}

}  // namespace hybrid_sphere
