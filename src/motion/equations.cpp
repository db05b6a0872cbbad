#include "motion/equations.hpp"

#include "sphere/contact_mode.hpp"

namespace hybrid_sphere::numeric {
namespace {

double decay_of(EquationForm form, const Dynamics& dynamics, const scene::Material& ground) {
  if (form == EquationForm::sliding || form == EquationForm::resisted_sliding)
    return dynamics.slip_decay(ground.friction);
  if (form == EquationForm::skidding) return dynamics.center_decay(ground.friction);
  if (form == EquationForm::resisted_rolling) return dynamics.roll_decay(ground.rolling_resistance);
  return 0;
}

}  // namespace

Equations::Equations(EquationForm form, const Dynamics& dynamics, const scene::Material& ground,
                     const Vector2d& start)
    : form_(form),
      dynamics_(dynamics),
      rate_(form == EquationForm::free ? 0 : ground.turntable_rate),
      ground_(form == EquationForm::free ? Vector2d(Vector2d::Zero()) : ground_velocity(ground, start)),
      decay_(decay_of(form, dynamics, ground)),
      roll_decay_(form == EquationForm::resisted_sliding ? dynamics.spinning_decay(ground.rolling_resistance)
                                                         : 0),
      affine_(!dynamics.has_drag() && dynamics.quadratic_drag == 0 && dynamics.spring_rate == 0) {
  dynamics_.spring_center -= start;
}

State Equations::start(const Vector2d& rate) const {
  State y = State::Zero();
  set_pair(y, 0, rate);
  if (form_ == EquationForm::sliding && !affine_) set_pair(y, 4, momentum_);
  return y;
}

State Equations::start(const Vector2d& slip, const Vector2d& nu) const {
  State y = State::Zero();
  set_pair(y, 0, slip);
  set_pair(y, 4, nu);
  return y;
}

Instant Equations::rolling(const Vector2d& d, const Vector2d& velocity, const Vector2d& nu) const {
  const double kappa = dynamics_.kappa;
  Instant now{velocity, nu, dynamics_.acceleration(d, velocity), dynamics_.spin_acceleration(nu), {}};
  const double share = form_ == EquationForm::resisted_rolling ? kappa - 1 : kappa;
  now.forcing = (1 - kappa) * now.force + kappa * now.spin + share * rate_ * turned(velocity);
  return now;
}

Instant Equations::sliding(const State& y) const {
  const double kappa = dynamics_.kappa;
  const Vector2d d = displacement(y);
  const Vector2d p_c = affine_ ? Vector2d(momentum_ + time_of(y) * dynamics_.rolling()) : pair(y, 4);
  const Vector2d sigma = pair(y, 0) + ground(d);
  Instant now{p_c + kappa * sigma, p_c - (1 - kappa) * sigma, {}, {}, {}};
  now.force = dynamics_.acceleration(d, now.velocity);
  now.spin = dynamics_.spin_acceleration(now.nu);
  now.forcing = now.force - now.spin - rate_ * turned(now.velocity);
  return now;
}

Instant Equations::resisted_sliding(const Vector2d& d, const Vector2d& slip, const Vector2d& nu) const {
  const Vector2d velocity = slip + nu + ground(d);
  Instant now{velocity, nu, dynamics_.acceleration(d, velocity), dynamics_.spin_acceleration(nu), {}};
  now.forcing = now.force - now.spin - rate_ * turned(velocity);
  return now;
}

Instant Equations::instant(const State& y) const {
  const Vector2d d = displacement(y);
  const Vector2d first = pair(y, 0);
  if (form_ == EquationForm::resisted_sliding) return resisted_sliding(d, first, pair(y, 4));
  if (form_ == EquationForm::skidding) {
    Instant now = resisted_sliding(d, first, Vector2d::Zero());
    now.forcing += now.spin;  // which the resistance holds
    return now;
  }
  if (form_ == EquationForm::sliding) return sliding(y);
  if (form_ == EquationForm::resisted_rolling) return rolling(d, first + ground(d), first);
  if (form_ == EquationForm::rolling) return rolling(d, first, first - ground(d));
  const Vector2d force = dynamics_.acceleration(d, first);
  return {first, Vector2d::Zero(), force, dynamics_.spin, force};
}

// |s||nu|/(|s| + |nu|)
double Equations::resisted_sliding_pace(const State& y) const {
  const double slip = pair(y, 0).norm();
  const double nu = pair(y, 4).norm();
  if (decay_ == 0) return nu;
  return slip + nu > 0 ? slip / (slip + nu) * nu : 0;
}

double Equations::pace_rate(const State& y, const State& rate) const {
  const auto growth = [&](Eigen::Index i) {
    const Vector2d w = pair(y, i);
    return w.dot(pair(rate, i)) / w.squaredNorm();
  };
  if (form_ != EquationForm::resisted_sliding) return growth(0);
  if (decay_ == 0) return growth(4);
  const double slip = pair(y, 0).norm();
  const double nu = pair(y, 4).norm();
  return growth(0) * (nu / (slip + nu)) + growth(4) * (slip / (slip + nu));
}

State Equations::resisted_sliding_derivative(const State& y, const Instant& now) const {
  const double kappa = dynamics_.kappa;
  const double slip = pair(y, 0).norm();
  const double nu = pair(y, 4).norm();
  const double length = pace(y);
  // length/|s| and length/|nu|: their sum is 1, but the smaller one is not what is left of that.
  const double of_slip = decay_ == 0 ? 0 : nu / (slip + nu);
  const double of_nu = decay_ == 0 ? 1 : slip / (slip + nu);
  const Vector2d friction = decay_ * of_slip * pair(y, 0);
  const Vector2d resistance = roll_decay_ * of_nu * pair(y, 4);
  State rate = State::Zero();
  set_pair(rate, 0, length * now.forcing - friction + resistance);
  set_pair(rate, 2, length * now.velocity);
  set_pair(rate, 4, length * now.spin + (1 - kappa) * friction - resistance);
  rate[6] = length;
  return rate;
}

State Equations::derivative(const State& y) const {
  const Instant now = instant(y);
  if (form_ == EquationForm::resisted_sliding) return resisted_sliding_derivative(y, now);
  State rate = State::Zero();
  if (!is_dry()) {
    set_pair(rate, 0, now.forcing);
    set_pair(rate, 2, now.velocity);
    rate[6] = 1;
    return rate;
  }
  const double length = pace(y);
  set_pair(rate, 0, length * now.forcing - decay_ * pair(y, 0));
  set_pair(rate, 2, length * now.velocity);
  if (form_ == EquationForm::sliding && !affine_) {
    const double kappa = dynamics_.kappa;
    set_pair(rate, 4, length * ((1 - kappa) * now.force + kappa * now.spin));
  }
  rate[6] = length;
  return rate;
}

Equations::Directions Equations::directions(const State& y, const Instant& now) const {
  const Vector2d slip = pair(y, 0);
  const Vector2d nu = pair(y, 4);
  const double of_slip = slip.norm();
  const double of_nu = nu.norm();
  if (of_slip > 0 && of_nu > 0) return {slip / of_slip, nu / of_nu};
  if (of_nu > 0) {
    const Vector2d e = nu / of_nu;
    if (decay_ == 0) return {Vector2d::Zero(), e};
    return {direction_at_rest(now.forcing + roll_decay_ * e, decay_), e};
  }
  const double kappa = dynamics_.kappa;
  if (decay_ == 0) return {Vector2d::Zero(), direction_at_rest(now.spin, roll_decay_)};
  if (of_slip > 0) {
    const Vector2d e = slip / of_slip;
    return {e, direction_at_rest(now.spin + (1 - kappa) * decay_ * e, roll_decay_)};
  }
  ContactForces forces;
  forces.drive = now.forcing + now.spin;
  forces.spin = now.spin;
  forces.kappa = kappa;
  forces.friction = kappa * decay_;
  forces.resistance = kappa / (1 - kappa) * roll_decay_;
  forces.drive_size = now.force.norm() + rate_ * now.velocity.norm();
  const ContactResponse response = contact_response(forces, slip, nu);
  return {-response.reaction / forces.friction, response.couple / forces.resistance};
}

Vector2d Equations::direction(const State& y, const Instant& now) const {
  if (form_ == EquationForm::resisted_sliding) return directions(y, now).slip;
  const Vector2d w = pair(y, 0);
  const double length = w.norm();
  return length > 0 ? Vector2d(w / length) : direction_at_rest(now.forcing, decay_);
}

DryVector Equations::dry_vector(int i, const State& y, const Instant& now) const {
  if (form_ != EquationForm::resisted_sliding) return {pair(y, 0), direction(y, now), now.forcing, decay_, 0};
  const Directions e = directions(y, now);
  const double by_friction = (1 - dynamics_.kappa) * decay_;
  if (i == 0) return {pair(y, 0), e.slip, now.forcing + roll_decay_ * e.nu, decay_, roll_decay_};
  return {pair(y, 4), e.nu, now.spin + by_friction * e.slip, roll_decay_, by_friction};
}

Vector2d Equations::acceleration(const State& y, const Instant& now) const {
  if (!is_dry()) return now.forcing;
  const Vector2d friction = center_decay() * direction(y, now);
  if (slides()) return now.force - friction;
  return now.forcing + rate_ * turned(now.velocity) - friction;
}

}  // namespace hybrid_sphere::numeric
