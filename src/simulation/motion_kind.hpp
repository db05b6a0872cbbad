#pragma once

#include <vector>

#include "simulation/constraint.hpp"

/// Which motion a segment has: the simplest one that the forces, the ground and the contact mode allow. The
/// only place where this is decided. Source: docs/theory.md 4.7.
namespace hybrid_sphere {

enum class MotionKind : std::uint8_t {
  uniform,       ///< both velocities are constant: UniformMotion
  linear,        ///< the equations are linear: LinearMotion
  dry_friction,  ///< dry friction under a constant force: DryFrictionMotion
  straight,      ///< the same against a rolling resistance, where no slip and no rolling turns: StraightSlide
  sticking,      ///< at rest relative to ground that turns, or that carries the sphere along a spring's force
  integrated,    ///< no closed form: a numerical method
};

/// Why a motion has no closed form.
enum class Obstacle : std::uint8_t {
  none,
  quadratic_drag,
  turntable,       ///< dry friction on turning ground
  drag,            ///< dry friction beside drag
  spring,          ///< dry friction beside a spring
  friction_limit,  ///< rolling resistance under a force on coulomb ground: the reaction turns, grip may be
                   ///< lost
  turning,         ///< sliding against a rolling resistance, but where neither slip nor rolling turns
  torque,          ///< a torque on a sphere that a rolling resistance keeps from turning while it slides
};

/// Whether forces on the centre depend on its place or velocity, or torques on the angular velocity.
inline bool has_changing_forces(const Dynamics& dynamics) {
  return dynamics.has_drag() || dynamics.quadratic_drag != 0 || dynamics.spring_rate != 0;
}

/// Obstacle to the closed form of dry friction, which requires a constant force and ground that does not
/// turn.
inline Obstacle obstacle_to_dry_friction(const Dynamics& dynamics, const scene::Material& material) {
  if (material.turntable_rate != 0) return Obstacle::turntable;
  if (dynamics.quadratic_drag != 0) return Obstacle::quadratic_drag;
  if (dynamics.has_drag()) return Obstacle::drag;
  return dynamics.spring_rate != 0 ? Obstacle::spring : Obstacle::none;
}

/// @param mode  any but edge_sliding, which always has a closed form
inline Obstacle obstacle_to_closed_form(const Dynamics& dynamics, ContactMode mode,
                                        const scene::Material& material) {
  if (mode == ContactMode::sticking || mode == ContactMode::edge_sliding) return Obstacle::none;
  if (mode == ContactMode::skidding && material.friction == 0) {  // only the forces act
    return dynamics.quadratic_drag != 0 ? Obstacle::quadratic_drag : Obstacle::none;
  }
  if (mode == ContactMode::sliding || mode == ContactMode::skidding) {
    const Obstacle obstacle = obstacle_to_dry_friction(dynamics, material);
    if (obstacle != Obstacle::none || !resists_rolling(dynamics, material)) return obstacle;
    if (mode == ContactMode::sliding) return Obstacle::turning;
    return dynamics.spin.isZero(0) ? Obstacle::none : Obstacle::torque;
  }
  if (mode == ContactMode::rolling && resists_rolling(dynamics, material)) {
    const Obstacle obstacle = obstacle_to_dry_friction(dynamics, material);
    const bool may_lose_grip = material.law == scene::Law::coulomb && dynamics.forced();
    return obstacle == Obstacle::none && may_lose_grip ? Obstacle::friction_limit : obstacle;
  }
  return dynamics.quadratic_drag != 0 ? Obstacle::quadratic_drag : Obstacle::none;
}

/// Whether the spin about the normal stays constant.
inline bool keeps_spin(const Dynamics& dynamics, ContactMode mode, const scene::Material& material,
                       double omega_3) {
  if (mode != ContactMode::free && material.law == scene::Law::rubber) return true;
  const bool rubs = mode != ContactMode::free && dynamics.spin_decay(material.spin_friction) != 0;
  return dynamics.normal_spin == 0 && (dynamics.rotational_drag == 0 || omega_3 == 0) &&
         (!rubs || omega_3 == material.turntable_rate);
}

/// Whether both velocities are constant.
/// @param omega_3  at the beginning [rad/s]
inline bool is_uniform(const Dynamics& dynamics, ContactMode mode, const scene::Material& material,
                       double omega_3) {
  const bool rubs = mode == ContactMode::skidding && material.friction != 0;
  if (mode == ContactMode::sliding || rubs || !keeps_spin(dynamics, mode, material, omega_3)) return false;
  if (mode == ContactMode::free) return !has_changing_forces(dynamics) && !dynamics.forced();
  if (mode == ContactMode::skidding) return !has_changing_forces(dynamics) && dynamics.free.isZero(0);
  if (material.turntable_rate != 0) return false;
  if (mode == ContactMode::sticking) return dynamics.spring_rate == 0 || material.belt.isZero(0);
  return !has_changing_forces(dynamics) && dynamics.rolling().isZero(0) &&
         !resists_rolling(dynamics, material);
}

/// @param mode   any but edge_sliding
/// @param omega_3  at the beginning [rad/s]
inline MotionKind motion_kind(const Dynamics& dynamics, ContactMode mode, const scene::Material& material,
                              double omega_3) {
  if (is_uniform(dynamics, mode, material, omega_3)) return MotionKind::uniform;
  if (obstacle_to_closed_form(dynamics, mode, material) != Obstacle::none) return MotionKind::integrated;
  if (mode == ContactMode::sticking) {
    const bool holds = material.turntable_rate == 0 && (dynamics.spring_rate == 0 || material.belt.isZero(0));
    return holds ? MotionKind::linear : MotionKind::sticking;
  }
  const bool is_dry = mode == ContactMode::sliding ||
                      (mode == ContactMode::skidding && material.friction != 0) ||
                      (mode == ContactMode::rolling && resists_rolling(dynamics, material));
  return is_dry ? MotionKind::dry_friction : MotionKind::linear;
}

/// The same if a numerical method is requested: everything that moves is integrated, except what the ground
/// carries along.
/// @param at_rest  whether both velocities are 0 at the beginning
inline MotionKind integrated_kind(const Dynamics& dynamics, ContactMode mode, const scene::Material& material,
                                  double omega_3, bool at_rest) {
  const MotionKind kind = motion_kind(dynamics, mode, material, omega_3);
  const bool stands = kind == MotionKind::uniform && at_rest;
  return stands || mode == ContactMode::sticking ? kind : MotionKind::integrated;
}

/// The contact modes that a ground may bring about, in the order in which they usually occur.
inline std::vector<ContactMode> contact_modes_on(const Dynamics& dynamics, const scene::Material& material) {
  const bool is_coulomb = material.law == scene::Law::coulomb;
  if (is_frictionless(dynamics, material)) return {ContactMode::free};
  std::vector<ContactMode> modes;
  if (is_coulomb) modes.push_back(ContactMode::sliding);
  if (is_coulomb && resists_rolling(dynamics, material)) modes.push_back(ContactMode::skidding);
  if (is_coulomb && material.friction == 0) return modes;
  modes.push_back(ContactMode::rolling);
  if (resists_rolling(dynamics, material)) modes.push_back(ContactMode::sticking);
  return modes;
}

}  // namespace hybrid_sphere
