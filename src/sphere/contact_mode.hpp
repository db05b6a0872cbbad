#pragma once

#include "sphere/dynamics.hpp"

/// What the ground does with a pressed sphere at an instant: the one place where it is decided whether slip
/// and rolling start, go on or are held at 0. Source: docs/theory.md 4.5, 4.6.
namespace hybrid_sphere {

/// What the ground does with the sphere from one switch to the next.
enum class ContactMode : std::uint8_t {
  free,          ///< no tangential force
  sliding,       ///< friction mu N against the slip, and a rolling resistance against turning
  skidding,      ///< the same, and the rolling resistance keeps the sphere from turning: nu = 0
  rolling,       ///< no slip
  sticking,      ///< no slip, and a rolling resistance holds the sphere at rest relative to the ground
  edge_sliding,  ///< along the edge between two grounds that throw the sphere at each other
};

/// The forces at an instant and the limits of what the ground can do against them, over the mass.
struct ContactForces {
  Vector2d drive = Vector2d::Zero();  ///< f - u': acceleration of the centre relative to the ground [m/s^2]
  Vector2d spin = Vector2d::Zero();   ///< g [m/s^2]
  double kappa = 0;                   ///< k^2/(R^2 + k^2)
  double friction = 0;                ///< mu N/m, `never` where the ground always grips [m/s^2]
  double resistance = 0;              ///< rho N/m [m/s^2]
  double drive_size = 0;  ///< of the terms of `drive`, which say how large its rounding is [m/s^2]

  /// @param velocity  of the centre [m/s]
  /// @param nu        R (omega_2, -omega_1) [m/s]
  ContactForces(const Dynamics& dynamics, const scene::Material& material, const Vector2d& position,
                const Vector2d& velocity, const Vector2d& nu);
  ContactForces() = default;
};

/// What follows: the right derivative of the motion.
struct ContactResponse {
  ContactMode mode = ContactMode::sliding;
  Vector2d reaction = Vector2d::Zero();   ///< lambda/m, force of the ground [m/s^2]
  Vector2d couple = Vector2d::Zero();     ///< c/m, couple of the rolling resistance over m R [m/s^2]
  Vector2d slip_rate = Vector2d::Zero();  ///< s' [m/s^2]
  Vector2d roll_rate = Vector2d::Zero();  ///< nu' [m/s^2]
};

/// Of all reactions abs(lambda) <= mu N and couples abs(c) <= rho N that the velocities s and nu allow, those
/// of least acceleration (s' + nu', nu') in the metric diag(m, m kappa/(1 - kappa)):
///   s' + nu' = f - u' + lambda/m,     nu' = g - (1 - kappa)/(kappa m) (lambda + c)
/// where lambda = -mu N s/abs(s) if s is not 0 and c = rho N nu/abs(nu) if nu is not 0. It is unique. What
/// rounding cannot tell from being held is held. Source: docs/theory.md 4.6; H. Brezis, Operateurs maximaux
/// monotones, 1973; J. J. Moreau, Unilateral contact and dry friction in finite freedom dynamics, 1988.
ContactResponse contact_response(const ContactForces& forces, const Vector2d& slip, const Vector2d& nu);

}  // namespace hybrid_sphere
