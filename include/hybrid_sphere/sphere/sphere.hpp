#pragma once

#include "hybrid_sphere/export.hpp"
#include "hybrid_sphere/sphere/twist.hpp"

/// The sphere itself: what follows from m, R and k alone. Symbols as in docs/theory.md: kappa =
/// k^2/(R^2+k^2), sigma the velocity of the contact point, u that of the ground, slip s = sigma - u.
namespace hybrid_sphere {

/// @code
/// const Sphere ball({1, 0.5, 0.5 * std::sqrt(0.4)});
/// const Twist before{{1, 0}, {0, 0, 0}};
/// const Vector2d impulse = ball.stopping_impulse(ball.contact_velocity(before));  // (-2/7, 0)
/// @endcode
class HYBRID_SPHERE_EXPORT Sphere {
 public:
  explicit Sphere(const scene::SphereBody& body);

  double mass() const { return mass_; }
  double radius() const { return radius_; }
  double gyration_radius() const { return gyration_radius_; }
  /// kappa = k^2/(R^2+k^2); m kappa is the effective mass of the contact point.
  double kappa() const { return kappa_; }

  /// sigma = (xd - R omega_2, yd + R omega_1) [m/s], each component rounded once. Source: (21).
  Vector2d contact_velocity(const Twist& twist) const;

  /// p_c = R/(R^2+k^2) (R xd + k^2 omega_2, R yd - k^2 omega_1) [m/s]: angular momentum about the contact
  /// point, which no contact force or impulse changes, expressed as a velocity. Each component is accurate to
  /// a few of its own ulps, so it vanishes exactly where the data say so. Source: docs/theory.md 3.1.
  Vector2d conserved_velocity(const Twist& twist) const;

  /// Kinetic energy (12) [J].
  double kinetic_energy(const Twist& twist) const;

  /// Velocities of rolling without slipping on ground with velocity u, for the given conserved velocity and
  /// spin about the normal: v = p_c + kappa u, omega = ((u_y - yd)/R, (xd - u_x)/R, omega_3). With p_c from
  /// before the impulse and u = 0 these are the corrected (23).
  Twist rolling_twist(const Vector2d& conserved_velocity, const Vector2d& ground_velocity,
                      double omega_3) const;

  /// P = -m kappa s [N s]: impulse of the ground that stops the slip s at once. Source: (20), (22).
  Vector2d stopping_impulse(const Vector2d& slip) const;

  /// Moment about the centre of an impulse at the contact point, (R P_y, -R P_x, 0) [N m s]. Source: (20).
  Vector3d angular_impulse(const Vector2d& impulse) const;

  /// Impulse of a couple about the normal that changes omega_3 by `change` [N m s].
  double spin_impulse(double change) const { return mass_ * gyration_radius_ * gyration_radius_ * change; }

 private:
  double mass_;
  double radius_;
  double gyration_radius_;
  double kappa_;
};

}  // namespace hybrid_sphere
