#include "motion/friction_limit.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "motion/held_bound.hpp"

namespace hybrid_sphere::numeric {

FrictionLimit::FrictionLimit(const Equations& equations, double coefficient)
    : equations_(&equations),
      of_couple_(equations.form() == EquationForm::skidding),
      limit_(of_couple_ ? equations.dynamics().spinning_decay(coefficient)
                        : equations.dynamics().slip_decay(coefficient)) {}

double FrictionLimit::share() const {
  const double kappa = equations_->dynamics().kappa;
  return (of_couple_ ? (1 - kappa) / kappa : 1 / kappa) * equations_->decay();
}

double FrictionLimit::noise(double size) const { return 8 * DBL_EPSILON * (size + limit_) * (size + limit_); }

Vector2d FrictionLimit::pull(const Instant& now, const Vector2d& e) const {
  if (of_couple_) return now.spin + share() * e;
  return now.force - now.spin - equations_->turntable_rate() * turned(now.velocity) +
         equations_->decay() / equations_->dynamics().kappa * e;
}

geometry::Jet FrictionLimit::jet(const State& y, const Vector2d& e, const Vector2d& turning,
                                 double pace) const {
  const Dynamics& dynamics = equations_->dynamics();
  const double rate = equations_->turntable_rate();
  const Instant now = equations_->instant(y);
  const Vector2d pull = this->pull(now, e);
  if (of_couple_) {
    return {(limit_ - pull.norm()) * (limit_ + pull.norm()), -2 * pull.dot(share() * turning),
            noise(now.spin.norm() + share())};
  }
  const double share = equations_->decay() / dynamics.kappa;
  const Vector2d carried = rate * turned(now.velocity);
  const Vector2d a =
      now.forcing - equations_->decay() * e + (equations_->is_dry() ? carried : Vector2d(Vector2d::Zero()));
  const double speed = now.velocity.norm();
  Vector2d force_rate = -dynamics.translational_drag * a - dynamics.spring_rate * now.velocity;
  if (dynamics.quadratic_drag != 0 && speed > 0) {
    force_rate -= dynamics.quadratic_drag * (speed * a + now.velocity * (now.velocity.dot(a) / speed));
  }
  const Vector2d spin_rate = -dynamics.rotational_drag * (a - carried);
  const Vector2d pull_rate = pace * (force_rate - spin_rate - rate * turned(a)) + share * turning;
  return {(limit_ - pull.norm()) * (limit_ + pull.norm()), -2 * pull.dot(pull_rate),
          noise(now.force.norm() + now.spin.norm() + carried.norm() + share)};
}

geometry::Jet FrictionLimit::along_trajectory(const State& y) const {
  if (!equations_->is_dry()) return jet(y, Vector2d::Zero(), Vector2d::Zero(), 1);
  const Instant now = equations_->instant(y);
  const Vector2d e = equations_->direction(y, now);
  return jet(y, e, turning(*equations_, now, e) * turned(e), equations_->pace(y));
}

geometry::Jet FrictionLimit::along_onset(const SlipOnset& onset, double tau) const {
  const State y = onset.at(tau);
  return jet(y, equations_->direction(y, equations_->instant(y)), onset.turning(tau), 1);
}

// q = B_s + (A/kappa) e,  abs(G'') <= 2 abs(q')^2 + 2 abs(q) abs(q''),  abs(q) <= abs(q_0) + abs(q') x. The
// part of v'' that comes from the friction's turning is A abs(de/dx) / (dtau/dx).
double FrictionLimit::bend(const State& y, const SpeedBound& bound, const ForcingBound& forcing,
                           const IntervalBounds& bounds) const {
  if (of_couple_) {
    const double q_rate = share() * bounds.turning;
    return 2 * q_rate * q_rate +
           2 * (equations_->instant(y).spin.norm() + share()) * share() * bounds.turning_bend;
  }
  const Dynamics& dynamics = equations_->dynamics();
  const double rate = std::abs(equations_->turntable_rate());
  const double decay = equations_->decay();
  const double share = decay / dynamics.kappa;
  const double first = forcing.force_rate + forcing.spin_rate + rate * bound.acceleration;
  const double second = forcing.force_bend + forcing.spin_bend + rate * bound.jerk;
  const double by_jerk = dynamics.translational_drag + 2 * dynamics.quadratic_drag * bound.speed +
                         dynamics.rotational_drag + rate;
  const double q_rate = bounds.pace * first + share * bounds.turning;
  const double q_bend = bounds.pace_rate * first + bounds.pace * bounds.pace * second +
                        by_jerk * bounds.pace * decay * bounds.turning + share * bounds.turning_bend;
  const Instant now = equations_->instant(y);
  const Vector2d e = equations_->is_dry() ? equations_->direction(y, now) : Vector2d(Vector2d::Zero());
  const double q = pull(now, e).norm() + q_rate * bounds.length;
  return 2 * q_rate * q_rate + 2 * q * q_bend;
}

double FrictionLimit::curvature(const State& y, double x, double duration) const {
  const SpeedBound bound(*equations_, y, duration);
  const ForcingBound forcing(*equations_, bound);
  if (!equations_->is_dry()) return bend(y, bound, forcing, {x, 0, 0, 1, 0});
  const double forcing_rate = forcing.forcing_rate(*equations_, bound);
  const Vector2d drive = equations_->instant(y).forcing;
  const double most = drive.norm() + forcing_rate * duration;
  const double pace = equations_->pace(y) + std::max(0.0, most - equations_->decay()) * duration;
  const double drift = pace * forcing_rate;
  const Vector2d e = equations_->direction(y, equations_->instant(y));
  const double turning = turning_bound(drive, e, most, drift, x);
  const IntervalBounds bounds{x, turning, drift + (most + turning) * turning, pace,
                              (most + equations_->decay()) * pace};
  if (!equations_->holds_velocity()) return bend(y, bound, forcing, bounds);
  return held_bend(y, duration, bound, bounds);
}

double FrictionLimit::held_bend(const State& y, double duration, SpeedBound bound,
                                IntervalBounds bounds) const {
  const HeldBound held(*equations_, y, bounds.length, duration, bound);
  bounds.turning = std::min(bounds.turning, held.turning);
  bounds.turning_bend = std::min(bounds.turning_bend, held.turning_bend);
  bounds.pace = std::min(bounds.pace, held.speed);
  bounds.pace_rate = std::min(bounds.pace_rate, held.growth * bounds.pace);
  bound.limit(*equations_, held.speed, held.growth + bounds.turning);
  return bend(y, bound, ForcingBound(*equations_, bound), bounds);
}

double FrictionLimit::curvature(const SlipOnset& onset) const {
  const State y = onset.at(0);
  const SpeedBound bound(*equations_, y, onset.end());
  const ForcingBound forcing(*equations_, bound);
  return bend(y, bound, forcing, {onset.end(), onset.turning_bound(1), onset.turning_bound(2), 1, 0});
}

// With t = F.J e: t' = F'.J e - (F.e) t and (F.e)' = F'.e + t^2. What moves as it is driven turns less and
// less, up to what the drive turns.
double turning_bound(const Vector2d& drive, const Vector2d& e, double most, double drift, double x) {
  const double along = drive.dot(e);
  if (!(along > 0 && drift * x <= 0.5 * along)) return most;
  return std::min(most, std::max(std::abs(drive.dot(turned(e))), 2 * drift / along));
}

}  // namespace hybrid_sphere::numeric
