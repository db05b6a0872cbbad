#include "sphere/dynamics.hpp"

namespace hybrid_sphere {

Dynamics::Dynamics(const Sphere& sphere, const scene::Forces& forces)
    : kappa(sphere.kappa()), radius(sphere.radius()), mass(sphere.mass()) {
  const double k = sphere.gyration_radius();
  const auto per_inertia = [&](double torque) { return torque / mass / k / k; };
  free = forces.wrench.force / mass + forces.gravity.head<2>();
  spin = radius * Vector2d(per_inertia(forces.wrench.torque.y()), -per_inertia(forces.wrench.torque.x()));
  normal_spin = per_inertia(forces.wrench.torque.z());
  normal_force = -mass * forces.gravity.z();
  translational_drag = forces.drag.translational / mass;
  rotational_drag = per_inertia(forces.drag.rotational);
  quadratic_drag = forces.drag.quadratic / mass;
  spring_rate = forces.spring.stiffness / mass;
  spring_center = forces.spring.center;
}

double Dynamics::spin_decay(double resistance) const {
  // R/k^2 = (1 - kappa)/(kappa R)
  return resistance * (normal_force / mass) * (1 - kappa) / (kappa * radius);
}

Vector2d Dynamics::acceleration(const Vector2d& position, const Vector2d& velocity) const {
  Vector2d sum = free - translational_drag * velocity;
  if (quadratic_drag != 0) sum -= quadratic_drag * velocity.norm() * velocity;
  if (spring_rate != 0) sum -= spring_rate * (position - spring_center);
  return sum;
}

}  // namespace hybrid_sphere
