#include "hybrid_sphere/simulation/constraint.hpp"

#include <stdexcept>

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

Constraint constraint_of(Regime regime, const scene::Material& material) {
  Constraint constraint;
  if (regime == Regime::free || regime == Regime::sliding) return constraint;
  constraint.kind = regime == Regime::edge_slide         ? Constraint::Kind::edge
                    : material.law == scene::Law::rubber ? Constraint::Kind::no_slip_no_spin
                                                         : Constraint::Kind::no_slip;
  constraint.belt = material.belt;
  constraint.rate = material.turntable_rate;
  if (constraint.rate != 0) constraint.center = material.turntable_center;
  return constraint;
}

Regime regime_without_slip(const Dynamics& dynamics, const scene::Material& material,
                           const Vector2d& position, const Vector2d& velocity) {
  const double kappa = dynamics.kappa;
  const Vector2d f = dynamics.acceleration(position, velocity);
  const Vector2d du = material.turntable_rate * turned(velocity);  // u'
  const Vector2d nu = velocity - ground_velocity(material, position);
  // nu' without a resistance
  const Vector2d rolled = (1 - kappa) * (f - du) + kappa * dynamics.spin_acceleration(nu);
  const bool may_slide = material.law == scene::Law::coulomb;
  const double grip = material.friction * dynamics.normal_force / dynamics.mass;
  const auto holds = [&](const Vector2d& acceleration) {  // lambda/m = v' - f
    return !may_slide || (acceleration - f).norm() <= grip;
  };
  if (!holds(rolled + du)) return Regime::sliding;
  if (!resists_rolling(dynamics, material)) return Regime::rolling;
  const double decay = dynamics.roll_decay(material.rolling_resistance);
  const bool is_held = nu.isZero(0) && rolled.norm() <= decay;
  const Vector2d direction = nu.isZero(0) ? rolled.normalized() : nu.normalized();
  if (!holds(is_held ? du : Vector2d(rolled + du - decay * direction))) {
    throw std::runtime_error("rolling resistance asks for a larger reaction than friction gives");
  }
  return is_held ? Regime::carried : Regime::rolling;
}

}  // namespace hybrid_sphere
