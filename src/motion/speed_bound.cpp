#include "motion/speed_bound.hpp"

#include <algorithm>
#include <cmath>

namespace hybrid_sphere::numeric {
namespace {

/// 0 times infinity is 0: a force that does not exist.
double times(double coefficient, double value) { return coefficient == 0 ? 0 : coefficient * value; }

}  // namespace

Drive drive_of(const Equations& equations, const Vector2d& d) {
  const Dynamics& dynamics = equations.dynamics();
  const Vector2d still = dynamics.free - dynamics.spring_rate * (d - dynamics.spring_center);
  const double friction = equations.center_decay();
  const EquationForm form = equations.form();
  if (form == EquationForm::free || equations.slides()) {
    return {still, friction, dynamics.spring_rate, form == EquationForm::free};
  }
  const double kappa = dynamics.kappa;
  const double share = kappa * dynamics.rotational_drag;
  return {(1 - kappa) * still + kappa * dynamics.spin + share * equations.ground(d), friction,
          (1 - kappa) * dynamics.spring_rate + share * std::abs(equations.turntable_rate()),
          form == EquationForm::rolling && share * equations.turntable_rate() == 0};
}

double driven_speed(double start, double alpha, double stiffness, double duration) {
  const double frequency = std::sqrt(stiffness);
  const double angle = times(frequency, duration);
  return times(start, std::cosh(angle)) +
         times(alpha, angle < 1e-4 ? duration * std::cosh(angle) : std::sinh(angle) / frequency);
}

SpeedBound::SpeedBound(const Equations& equations, const State& y, double duration) {
  const Dynamics& dynamics = equations.dynamics();
  const bool rolls =
      equations.form() == EquationForm::rolling || equations.form() == EquationForm::resisted_rolling;
  const double kappa = rolls ? dynamics.kappa : 0;
  const double rate = std::abs(equations.turntable_rate());
  const double start = equations.instant(y).velocity.norm();
  const Drive drive = drive_of(equations, displacement(y));
  const double alpha = drive.drive.norm() + drive.friction;
  const double frequency = std::sqrt(drive.stiffness);
  speed = driven_speed(start, alpha, drive.stiffness, duration);
  double pull = alpha + times(drive.stiffness, times(speed, duration));
  if (drive.conserves && frequency > 0) {
    // (v^2 + abs(drive - gamma (d - d_0))^2/gamma)/2 does not grow.
    const double energy = std::hypot(start, alpha / frequency);
    speed = std::min(speed, energy);
    pull = std::min(pull, frequency * energy);
  }
  const double linear = (1 - kappa) * dynamics.translational_drag + kappa * dynamics.rotational_drag;
  const double quadratic = (1 - kappa) * dynamics.quadratic_drag;
  acceleration = pull + times(linear + kappa * rate, speed) + times(quadratic, speed * speed);
  bound_jerk(equations);
  bound_roll(equations, y, duration);
}

void SpeedBound::bound_jerk(const Equations& equations) {
  const Dynamics& dynamics = equations.dynamics();
  const bool rolls =
      equations.form() == EquationForm::rolling || equations.form() == EquationForm::resisted_rolling;
  const double kappa = rolls ? dynamics.kappa : 0;
  const double rate = std::abs(equations.turntable_rate());
  const double quadratic = (1 - kappa) * dynamics.quadratic_drag;
  jerk = times((1 - kappa) * dynamics.translational_drag + kappa * (dynamics.rotational_drag + rate),
               acceleration) +
         times(2 * quadratic, speed * acceleration) +
         times((1 - kappa) * dynamics.spring_rate + kappa * dynamics.rotational_drag * rate, speed);
}

void SpeedBound::limit(const Equations& equations, double by_speed, double by_acceleration) {
  speed = std::min(speed, by_speed);
  acceleration = std::min(acceleration, by_acceleration);
  bound_jerk(equations);
  if (equations.form() != EquationForm::resisted_rolling) return;
  roll = acceleration;
  roll_rate = jerk;
}

void SpeedBound::bound_roll(const Equations& equations, const State& y, double duration) {
  const Dynamics& dynamics = equations.dynamics();
  const double rate = std::abs(equations.turntable_rate());
  const EquationForm form = equations.form();
  if (form == EquationForm::free || form == EquationForm::skidding) {
    roll = roll_rate = 0;
  } else if (equations.slides()) {
    const double pull =
        dynamics.spin.norm() + (1 - dynamics.kappa) * equations.decay() + equations.roll_decay();
    const double most = equations.instant(y).nu.norm() + times(pull, duration);
    roll = pull + times(dynamics.rotational_drag, most);
    roll_rate = times(dynamics.rotational_drag, roll);
  } else {
    roll = acceleration + times(rate, speed);
    roll_rate = jerk + times(rate, acceleration);
  }
}

ForcingBound::ForcingBound(const Equations& equations, const SpeedBound& bound) {
  const Dynamics& dynamics = equations.dynamics();
  const double jerk = bound.jerk;
  const double a = bound.acceleration;
  // abs((abs(v) v)') <= 2 abs(v) abs(v'),  abs((abs(v) v)'') <= 3 abs(v')^2 + 2 abs(v) abs(v'')
  force_rate = times(dynamics.translational_drag, a) + times(2 * dynamics.quadratic_drag, bound.speed * a) +
               times(dynamics.spring_rate, bound.speed);
  force_bend = times(dynamics.translational_drag, jerk) +
               times(dynamics.quadratic_drag, 3 * a * a + 2 * bound.speed * jerk) +
               times(dynamics.spring_rate, a);
  spin_rate = times(dynamics.rotational_drag, bound.roll);
  spin_bend = times(dynamics.rotational_drag, bound.roll_rate);
}

double ForcingBound::forcing_rate(const Equations& equations, const SpeedBound& bound) const {
  const double rate = std::abs(equations.turntable_rate());
  if (equations.slides()) return force_rate + rate * bound.acceleration;
  const double kappa = equations.dynamics().kappa;
  return (1 - kappa) * force_rate + kappa * spin_rate + (1 - kappa) * rate * bound.acceleration;
}

}  // namespace hybrid_sphere::numeric
