#include "simulation/constraint.hpp"

#include <cfloat>

#include "sphere/contact_mode.hpp"

namespace hybrid_sphere {

bool same_ground(const scene::Material& a, const scene::Material& b) {
  return a.law == b.law && a.friction == b.friction && a.rolling_resistance == b.rolling_resistance &&
         a.spin_friction == b.spin_friction && a.belt == b.belt && a.turntable_rate == b.turntable_rate &&
         (a.turntable_rate == 0 || a.turntable_center == b.turntable_center);
}

bool Constraint::keeps_from_slipping_on(const scene::Material& material) const {
  return (kind == Kind::no_slip || kind == Kind::no_slip_no_spin) && belt == material.belt &&
         rate == material.turntable_rate && (rate == 0 || center == material.turntable_center);
}

bool Constraint::operator==(const Constraint& other) const {
  if (kind != other.kind) return false;
  if (kind == Kind::none) return true;
  return belt == other.belt && rate == other.rate && (rate == 0 || center == other.center);
}

Constraint constraint_of(ContactMode mode, const scene::Material& material) {
  Constraint constraint;
  if (mode == ContactMode::free || mode == ContactMode::sliding || mode == ContactMode::skidding)
    return constraint;
  constraint.kind = mode == ContactMode::edge_sliding    ? Constraint::Kind::edge
                    : material.law == scene::Law::rubber ? Constraint::Kind::no_slip_no_spin
                                                         : Constraint::Kind::no_slip;
  constraint.belt = material.belt;
  constraint.rate = material.turntable_rate;
  if (constraint.rate != 0) constraint.center = material.turntable_center;
  return constraint;
}

namespace {

/// Whether friction alone, without a rolling resistance, lets the sphere roll.
bool grips_without_resistance(const Dynamics& dynamics, const scene::Material& material,
                              const Vector2d& position, const Vector2d& velocity, const Vector2d& nu) {
  const double kappa = dynamics.kappa;
  const Vector2d f = dynamics.acceleration(position, velocity);
  const Vector2d du = material.turntable_rate * turned(velocity);  // u'
  const Vector2d rolled = (1 - kappa) * (f - du) + kappa * dynamics.spin_acceleration(nu);
  return (rolled + du - f).norm() <= material.friction * dynamics.normal_force / dynamics.mass;
}

}  // namespace

ContactMode contact_mode_on(const Dynamics& dynamics, const scene::Material& material,
                            const Vector2d& position, const Vector2d& velocity, const Vector2d& slip,
                            const Vector2d& nu) {
  if (is_frictionless(dynamics, material)) return ContactMode::free;
  const bool may_slide = material.law == scene::Law::coulomb;
  if (!resists_rolling(dynamics, material)) {
    if (!may_slide) return ContactMode::rolling;
    const bool rolls = slip.isZero(0) && grips_without_resistance(dynamics, material, position, velocity, nu);
    return rolls ? ContactMode::rolling : ContactMode::sliding;
  }
  const ContactForces forces(dynamics, material, position, velocity, nu);
  return contact_response(forces, slip, nu).mode;
}

ContactMode contact_mode_from_rest(const Dynamics& dynamics, const scene::Material& material,
                                   const Vector2d& position) {
  constexpr double part = 0x1p-40;  // of the drive, as required by an onset (motion/slip_onset.hpp)
  const Vector2d still = Vector2d::Zero();
  const ContactForces forces(dynamics, material, position, ground_velocity(material, position), still);
  const ContactResponse response = contact_response(forces, still, still);
  const double told = part * (forces.drive_size + forces.spin.norm());
  if (response.roll_rate.norm() > told) return ContactMode::rolling;
  return response.slip_rate.norm() > told ? ContactMode::skidding : ContactMode::sticking;
}

bool needs_all_friction(const Dynamics& dynamics, const scene::Material& material, const Vector2d& position) {
  constexpr double told = 64 * DBL_EPSILON;
  const ContactForces forces(dynamics, material, position, ground_velocity(material, position),
                             Vector2d::Zero());
  return forces.friction < never &&
         forces.drive.norm() >= forces.friction - told * (forces.drive_size + forces.friction);
}

}  // namespace hybrid_sphere
