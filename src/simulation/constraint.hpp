#pragma once

#include "sphere/contact_mode.hpp"

namespace hybrid_sphere {

/// Whether two grounds are the same except for their place.
bool same_ground(const scene::Material& a, const scene::Material& b);

/// The constraint on the velocities in force.
struct Constraint {
  enum class Kind : std::uint8_t {
    none,             ///< smooth ground, or slip
    no_slip,          ///< sigma = u(r)
    no_slip_no_spin,  ///< the same, and omega_3 = W
    edge,             ///< the centre stays on an edge
  };
  Kind kind = Kind::none;
  Vector2d belt = Vector2d::Zero();
  double rate = 0;
  Vector2d center = Vector2d::Zero();

  bool holds() const { return kind != Kind::none; }
  /// Whether the constraint keeps the slip relative to this ground at 0.
  bool keeps_from_slipping_on(const scene::Material& material) const;
  bool operator==(const Constraint& other) const;
};

Constraint constraint_of(ContactMode mode, const scene::Material& material);

/// How a sphere moves on ground that presses on it: carried along, rolling, or sliding, turning or not.
/// Source: docs/theory.md 4.5, 4.6.
/// @param velocity  of the centre [m/s]
/// @param slip      sigma - u(r), exactly 0 where there is none [m/s]
/// @param nu        R (omega_2, -omega_1), exactly 0 where the sphere does not turn [m/s]
ContactMode contact_mode_on(const Dynamics& dynamics, const scene::Material& material,
                            const Vector2d& position, const Vector2d& velocity, const Vector2d& slip,
                            const Vector2d& nu);

/// The mode of a sphere at rest on ground with a rolling resistance where rounding hides whether the ground
/// holds it: turning or slip if it begins by more than rounding, otherwise neither.
ContactMode contact_mode_from_rest(const Dynamics& dynamics, const scene::Material& material,
                                   const Vector2d& position);

/// Whether carrying a sphere along takes all available friction, to within rounding: if it then breaks loose,
/// it slides and does not roll.
bool needs_all_friction(const Dynamics& dynamics, const scene::Material& material, const Vector2d& position);

/// Whether a ground has neither friction nor a rolling resistance.
inline bool is_frictionless(const Dynamics& dynamics, const scene::Material& material) {
  return material.law == scene::Law::smooth ||
         (material.law == scene::Law::coulomb && material.friction == 0 &&
          dynamics.roll_decay(material.rolling_resistance) == 0);
}

/// Whether a ground gives the sphere a velocity at once, by an impulse.
inline bool sets_velocity(const scene::Material& material) {
  return material.law == scene::Law::rough || material.law == scene::Law::rubber;
}

/// Whether a resistance slows turning on this ground.
inline bool resists_rolling(const Dynamics& dynamics, const scene::Material& material) {
  return dynamics.roll_decay(material.rolling_resistance) > 0;
}

}  // namespace hybrid_sphere
