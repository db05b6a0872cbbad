#pragma once

#include "hybrid_sphere/sphere/sphere.hpp"
#include "sphere/constants.hpp"

namespace hybrid_sphere {

/// Forces on a sphere, but those of the ground, as accelerations. With nu = R (omega_2, -omega_1) and a
/// reaction lambda in the plane the equations of motion are
///   v'  = f(r, v) + lambda/m,     f = free - translational_drag v - quadratic_drag abs(v) v
///                                     - spring_rate (r - spring_center)
///   nu' = g(nu) - R^2/(m k^2) lambda,     g = spin - rotational_drag nu
///   omega_3' = normal_spin - rotational_drag omega_3
/// so that p_c' = (1 - kappa) f + kappa g whatever the ground does. Source: docs/theory.md 3.1, 4.1.
struct Dynamics {
  Dynamics(const Sphere& sphere, const scene::Forces& forces);

  double kappa;               ///< k^2/(R^2 + k^2)
  double radius;              ///< R [m]
  double mass;                ///< m [kg]
  Vector2d free;              ///< force on the centre over m, with gravity's part in the plane [m/s^2]
  Vector2d spin;              ///< R (tau_2, -tau_1)/(m k^2) [m/s^2]
  double normal_spin;         ///< tau_3/(m k^2) [rad/s^2]
  double normal_force;        ///< N [N], >= 0
  double translational_drag;  ///< c/m [1/s]
  double rotational_drag;     ///< c/(m k^2) [1/s]
  double quadratic_drag;      ///< c/m [1/m]
  double spring_rate;         ///< stiffness/m [1/s^2]
  Vector2d spring_center;     ///< [m]

  /// a_0 = (1 - kappa) free + kappa spin: acceleration of rolling on still ground without drag or spring.
  Vector2d rolling() const { return (1 - kappa) * free + kappa * spin; }
  /// b = free - spin: acceleration of the contact point without a reaction.
  Vector2d slipping() const { return free - spin; }
  /// A = mu N/(m kappa): rate at which friction uses up slip [m/s^2].
  double slip_decay(double friction) const { return friction * normal_force / (mass * kappa); }
  /// Rate at which a rolling resistance uses up rolling, rho (1 - kappa) N/m [m/s^2].
  double roll_decay(double resistance) const { return resistance * (1 - kappa) * normal_force / mass; }
  /// Rate at which friction changes the velocity of a sphere that slides, mu N/m [m/s^2].
  double center_decay(double friction) const { return friction * normal_force / mass; }
  /// Rate at which a rolling resistance uses up nu beside a slip, A_r/kappa = rho (1 - kappa) N/(m kappa)
  /// [m/s^2].
  double spinning_decay(double resistance) const { return roll_decay(resistance) / kappa; }
  /// Rate at which a spin friction uses up spin about the normal, rho R N/(m k^2) [rad/s^2].
  double spin_decay(double resistance) const;

  /// f(r, v).
  Vector2d acceleration(const Vector2d& position, const Vector2d& velocity) const;
  /// g(nu).
  Vector2d spin_acceleration(const Vector2d& nu) const { return spin - rotational_drag * nu; }

  bool forced() const { return !free.isZero(0) || !spin.isZero(0); }
  bool has_drag() const { return translational_drag != 0 || rotational_drag != 0; }
};

/// u(r) of a ground.
inline Vector2d ground_velocity(const scene::Material& material, const Vector2d& position) {
  if (material.turntable_rate == 0) return material.belt;
  return material.belt + material.turntable_rate * turned(position - material.turntable_center);
}

}  // namespace hybrid_sphere
