#include "hybrid_sphere/solver/equations.hpp"

namespace hybrid_sphere::solver {
namespace {

double decay_of(Regime regime, const Dynamics& dynamics, const scene::Material& ground) {
  if (regime == Regime::sliding) return dynamics.slip_decay(ground.friction);
  if (regime == Regime::resisted) return dynamics.roll_decay(ground.rolling_resistance);
  return 0;
}

}  // namespace

Equations::Equations(Regime regime, const Dynamics& dynamics, const scene::Material& ground,
                     const Vector2d& start)
    : regime_(regime),
      dynamics_(dynamics),
      rate_(regime == Regime::free ? 0 : ground.turntable_rate),
      ground_(regime == Regime::free ? Vector2d(Vector2d::Zero()) : ground_velocity(ground, start)),
      decay_(decay_of(regime, dynamics, ground)),
      affine_(!dynamics.has_drag() && dynamics.quadratic_drag == 0 && dynamics.spring_rate == 0) {
  dynamics_.spring_center -= start;
}

State Equations::start(const Vector2d& rate) const {
  State y = State::Zero();
  y.head<2>() = rate.array();
  if (regime_ == Regime::sliding && !affine_) y.segment<2>(4) = momentum_.array();
  return y;
}

Instant Equations::rolling(const Vector2d& d, const Vector2d& velocity, const Vector2d& nu) const {
  const double kappa = dynamics_.kappa;
  Instant now{velocity, nu, dynamics_.acceleration(d, velocity), dynamics_.spin_acceleration(nu), {}};
  const double share = regime_ == Regime::resisted ? kappa - 1 : kappa;
  now.forcing = (1 - kappa) * now.force + kappa * now.spin + share * rate_ * turned(velocity);
  return now;
}

Instant Equations::sliding(const State& y) const {
  const double kappa = dynamics_.kappa;
  const Vector2d d = displacement(y);
  const Vector2d p_c =
      affine_ ? Vector2d(momentum_ + time_of(y) * dynamics_.rolling()) : Vector2d(y.segment<2>(4).matrix());
  const Vector2d sigma = y.head<2>().matrix() + ground(d);
  Instant now{p_c + kappa * sigma, p_c - (1 - kappa) * sigma, {}, {}, {}};
  now.force = dynamics_.acceleration(d, now.velocity);
  now.spin = dynamics_.spin_acceleration(now.nu);
  now.forcing = now.force - now.spin - rate_ * turned(now.velocity);
  return now;
}

Instant Equations::instant(const State& y) const {
  const Vector2d d = displacement(y);
  const Vector2d first = y.head<2>().matrix();
  if (regime_ == Regime::sliding) return sliding(y);
  if (regime_ == Regime::resisted) return rolling(d, first + ground(d), first);
  if (regime_ == Regime::rolling) return rolling(d, first, first - ground(d));
  const Vector2d force = dynamics_.acceleration(d, first);
  return {first, Vector2d::Zero(), force, dynamics_.spin, force};
}

State Equations::derivative(const State& y) const {
  const Instant now = instant(y);
  State rate = State::Zero();
  if (!is_dry()) {
    rate.head<2>() = now.forcing.array();
    rate.segment<2>(2) = now.velocity.array();
    rate[6] = 1;
    return rate;
  }
  const double length = pace(y);
  rate.head<2>() = length * now.forcing.array() - decay_ * y.head<2>();
  rate.segment<2>(2) = length * now.velocity.array();
  if (regime_ == Regime::sliding && !affine_) {
    const double kappa = dynamics_.kappa;
    rate.segment<2>(4) = length * ((1 - kappa) * now.force + kappa * now.spin).array();
  }
  rate[6] = length;
  return rate;
}

Vector2d Equations::direction(const State& y, const Instant& now) const {
  const Vector2d w = y.head<2>().matrix();
  const double length = w.norm();
  return length > 0 ? Vector2d(w / length) : direction_at_rest(now.forcing, decay_);
}

Vector2d Equations::acceleration(const State& y, const Instant& now) const {
  if (!is_dry()) return now.forcing;
  const Vector2d friction = center_decay() * direction(y, now);
  if (regime_ == Regime::sliding) return now.force - friction;
  return now.forcing + rate_ * turned(now.velocity) - friction;
}

}  // namespace hybrid_sphere::solver
