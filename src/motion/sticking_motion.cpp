#include "motion/sticking_motion.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "motion/phi.hpp"

namespace hybrid_sphere::numeric {

StickingMotion::StickingMotion(const Equations& equations)
    : equations_(&equations), ground_(equations.ground(Vector2d::Zero())) {}

State StickingMotion::at(double tau) const {
  State y = State::Zero();
  const Complex angle(0, equations_->turntable_rate() * tau);
  set_pair(y, 2, to_vector(to_complex(ground_) * tau * phi1(angle)));
  y[6] = tau;
  return y;
}

double StickingMotion::repeats() const {
  const double rate = std::abs(equations_->turntable_rate());
  if (rate > 0) return 7 / rate;  // more than 2 pi
  return speed() == 0 || equations_->dynamics().spring_rate == 0 ? DBL_MIN : never;
}

double StickingMotion::next_piece(double from) const {
  const double rate = std::abs(equations_->turntable_rate());
  if (rate > 0) return from + 0.5 / rate;
  const double change = equations_->dynamics().spring_rate * speed();
  const double first = change > 0 ? equations_->decay() / change : 1;
  return from + std::max(from, first > 0 ? first : 1);
}

double StickingMotion::first_breaking(double from, double until) const {
  const double kappa = equations_->dynamics().kappa;
  return first_excess(1 - kappa, kappa, 1 - kappa, raise_ * equations_->decay(), from, until);
}

double StickingMotion::first_slipping(double friction, double from, double until) const {
  const double kappa = equations_->dynamics().kappa;
  return first_excess(1, 0, 1, raise_ * kappa * equations_->dynamics().slip_decay(friction), from, until);
}

// The excess of abs(q) over a limit, q = force_share f + spin_share spin - turn_share W J v, where v has a
// constant length and turns at the rate W.
double StickingMotion::first_excess(double force_share, double spin_share, double turn_share, double limit,
                                    double from, double until) const {
  const Dynamics& dynamics = equations_->dynamics();
  const double rate = equations_->turntable_rate();
  const double speed = this->speed();
  const double drag = dynamics.translational_drag + dynamics.quadratic_drag * speed;
  const double spring = dynamics.spring_rate;
  const auto margin = [&](double x) {
    const State y = at(from + x);
    const Instant now = equations_->instant(y);
    const Vector2d turned_velocity = rate * turned(now.velocity);
    const Vector2d pull = force_share * now.force + spin_share * dynamics.spin - turn_share * turned_velocity;
    const Vector2d pull_rate = force_share * (-drag * turned_velocity - spring * now.velocity) +
                               turn_share * rate * rate * now.velocity;
    const double size = now.force.norm() + dynamics.spin.norm() + turned_velocity.norm() + limit;
    return geometry::Jet{(limit - pull.norm()) * (limit + pull.norm()), -2 * pull.dot(pull_rate),
                         8 * DBL_EPSILON * size * size};
  };
  const double turn = std::abs(rate);
  const double q_rate = (force_share * (drag * turn + spring) + turn_share * turn * turn) * speed;
  if (q_rate == 0) return margin(0).value < -margin(0).noise ? from : never;  // nothing changes
  const double duration = until - from;
  const State y = at(from);
  const Instant now = equations_->instant(y);
  const double q =
      (force_share * now.force + spin_share * dynamics.spin - turn_share * rate * turned(now.velocity))
          .norm() +
      q_rate * duration;
  const double curvature = 2 * q_rate * q_rate + 2 * q * turn * q_rate;
  return from + first_loss(
                    margin, [curvature](double, double) { return curvature; }, duration);
}

}  // namespace hybrid_sphere::numeric
