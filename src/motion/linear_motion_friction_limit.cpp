#include "motion/linear_motion.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "geometry/certified_root.hpp"

/// When rolling on coulomb ground loses its grip: lambda/m is a linear function of the motion.
namespace hybrid_sphere {

LinearMotion::Reaction LinearMotion::reaction_at(double tau) const {
  const Complex& beta = response_.beta();
  const Complex& gamma = response_.gamma();
  const Shifted now = placed(tau);
  const Complex velocity = to_complex(now.center.velocity);
  const Complex acceleration = to_complex(now.center.acceleration);
  const Complex third = beta * acceleration + gamma * velocity;
  const Complex fourth = beta * third + gamma * acceleration;
  return {per_velocity_ * velocity + per_shift_ * now.shift + constant_reaction_,
          per_velocity_ * acceleration + per_shift_ * velocity,
          per_velocity_ * third + per_shift_ * acceleration, per_velocity_ * fourth + per_shift_ * third};
}

Vector2d LinearMotion::reaction(double tau) const {
  return rolling_ ? to_vector(reaction_at(tau).value) : Vector2d::Zero();
}

// Bound on the second derivative of abs(lambda/m)^2. The second derivative of lambda obeys the homogeneous
// equation of motion.
double LinearMotion::reaction_bend(double from, double until) const {
  const double span = until - from;
  const Reaction now = reaction_at(from);
  const double linear = (std::abs(response_.smaller_root()) + std::abs(response_.beta())) * span;
  const double growth = std::exp(response_.growth() * span);
  const double bend = growth * ((1 + linear) * std::abs(now.bend) + std::abs(now.jerk) * span);
  const double slope = std::abs(now.slope) + bend * span;
  const double value = std::abs(now.value) + slope * span;
  return 2 * (slope * slope + value * bend) * (1 + 0x1p-40);
}

// Bound on abs(lambda/m) from a time on for ever: its final value and its two modes.
double LinearMotion::largest_reaction(double from) const {
  if (response_.growth() > 0) return never;
  const Complex& beta = response_.beta();
  const Complex& gamma = response_.gamma();
  const Reaction now = reaction_at(from);
  // value'' = beta value' + gamma (value - final)
  const Complex off = gamma == 0.0 ? now.slope / beta : (now.bend - beta * now.slope) / gamma;
  const double bound = std::abs(now.value - off) + modal_bound(off, now.slope, 0);
  return std::isnan(bound) ? never : bound;
}

double LinearMotion::first_loss(double from, double until) const {
  const auto excess = [this](double tau) -> geometry::Jet {
    const Reaction now = reaction_at(tau);
    const Shifted place = placed(tau);
    const double size = std::abs(now.value);
    const double terms = std::abs(per_velocity_) * place.center.velocity.norm() +
                         std::abs(per_shift_) * std::abs(place.shift) + std::abs(constant_reaction_);
    return {(size - limit_) * (size + limit_), 2 * (std::conj(now.value) * now.slope).real(),
            8 * DBL_EPSILON * (size + limit_) * (terms + limit_)};
  };
  double loss = never;
  geometry::certified_roots(
      excess, [this](double low, double high) { return reaction_bend(low, high); }, from, until,
      [&](const geometry::Root& root) {
        if (!(excess(root.time).slope > 0)) return true;
        loss = root.time;
        return false;
      });
  return loss;
}

double LinearMotion::end_before(double horizon) {
  const bool changes = per_velocity_ != 0.0 || per_shift_ != 0.0;
  if (!(limit_ < never) || !changes) return never;
  const Complex& beta = response_.beta();
  const bool circles = response_.gamma() == 0.0 && beta.real() == 0;
  const double pace = std::max(std::abs(response_.larger_root()), std::abs(beta));
  // A circle keeps the size of its reaction, a cycloid repeats it.
  if (circles && drive_ == 0.0 && constant_reaction_ == 0.0) return never;
  const double last = circles ? std::min(horizon, 7 / pace) : horizon;
  while (held_until_ < last && grip_lost_ == never) {
    if (largest_reaction(held_until_) * (1 + 0x1p-40) < limit_) {
      held_until_ = never;
      break;
    }
    const double until = std::max(held_until_ + 1 / pace, std::nextafter(held_until_, never));
    grip_lost_ = first_loss(held_until_, until);
    held_until_ = until;
  }
  return grip_lost_ <= horizon ? grip_lost_ : never;
}

}  // namespace hybrid_sphere
