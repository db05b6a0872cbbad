#pragma once

#include "hybrid_sphere/sphere/dynamics.hpp"

namespace hybrid_sphere {

/// What the ground does with the sphere from one switch to the next.
enum class Regime : std::uint8_t {
  free,        ///< no tangential force
  sliding,     ///< friction mu N against the slip
  rolling,     ///< no slip
  carried,     ///< no slip, and a rolling resistance holds the sphere at rest relative to the ground
  edge_slide,  ///< along the edge between two grounds that throw the sphere at each other
};

/// Whether two grounds differ in nothing but their place.
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
  /// Whether it keeps the slip relative to this ground at 0.
  bool keeps_from_slipping_on(const scene::Material& material) const;
  /// Whether it keeps the spin relative to this ground at 0.
  bool keeps_from_spinning_on(const scene::Material& material) const {
    return kind == Kind::no_slip_no_spin && rate == material.turntable_rate;
  }
  bool operator==(const Constraint& other) const;
  bool operator!=(const Constraint& other) const { return !(*this == other); }
};

Constraint constraint_of(Regime regime, const scene::Material& material);

/// What the ground does with a sphere that does not slip on it: whether it can roll, is held by a rolling
/// resistance or has to slide. Source: docs/theory.md 4.5, 4.6.
/// @param velocity  of the centre, with sigma = u(r) [m/s]
/// @throws std::runtime_error  where rolling without the resistance would hold, but with it takes more than
/// the grip: there this model of the resistance has no motion
Regime regime_without_slip(const Dynamics& dynamics, const scene::Material& material,
                           const Vector2d& position, const Vector2d& velocity);

/// Whether rolling on this ground is slowed down by a resistance.
inline bool resists_rolling(const Dynamics& dynamics, const scene::Material& material) {
  return dynamics.roll_decay(material.rolling_resistance) > 0;
}

}  // namespace hybrid_sphere
