#include "motion/held_bound.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace hybrid_sphere::numeric {
namespace {

double kappa_of(const Equations& equations) {
  return equations.form() == EquationForm::skidding ? 0 : equations.dynamics().kappa;
}

/// Of F, F.e, F.J e and F.e - A: up to 16 roundings of half an ulp of all that is added up.
double rounding_of(const Equations& equations, const State& y, double speed) {
  const Dynamics& dynamics = equations.dynamics();
  const double kappa = kappa_of(equations);
  const double of_spin = kappa > 0 ? kappa : 1;  // of what skids it is subtracted and added again
  const double force = dynamics.free.norm() +
                       dynamics.spring_rate * (displacement(y).norm() + dynamics.spring_center.norm()) +
                       (dynamics.translational_drag + dynamics.quadratic_drag * speed) * speed;
  const double spin = dynamics.spin.norm() + dynamics.rotational_drag * speed;
  return 8 * DBL_EPSILON * ((1 - kappa) * force + of_spin * spin + equations.decay());
}

}  // namespace

double turning(const Equations& equations, const Instant& now, const Vector2d& e) {
  constexpr double told = 2 * DBL_EPSILON;
  const double across = now.forcing.dot(turned(e));
  const bool straight = equations.holds_velocity() && std::abs(across) <= told * now.forcing.dot(e);
  return straight ? 0 : across;
}

HeldBound::HeldBound(const Equations& equations, const State& y, double x, double duration,
                     const SpeedBound& coarse) {
  const Dynamics& dynamics = equations.dynamics();
  const Instant now = equations.instant(y);
  const double start = now.velocity.norm();
  const double decay = equations.decay();
  const double rounding = rounding_of(equations, y, start);
  // abs(v)' <= abs(drive) - A + gamma abs(d - d_0), drag only slows it down
  const Drive drive = drive_of(equations, displacement(y));
  const double excess = std::max(0.0, drive.drive.norm() - decay) + rounding;
  speed = std::min(coarse.speed, driven_speed(start, excess, drive.stiffness, duration));
  SpeedBound bound = coarse;
  bound.speed = speed;
  const double change = ForcingBound(equations, bound).forcing_rate(equations, bound) * duration + rounding;
  const Vector2d e = equations.direction(y, now);
  const double along = now.forcing.dot(e);
  const double least = along - change;
  const double most = now.forcing.norm() + change;
  growth = std::max(most - decay, decay - least);
  const double across = std::abs(numeric::turning(equations, now, e));
  turning = across == 0 && least > 0
                ? 0
                : std::min(most, (across + rounding) * std::exp(std::max(0.0, -least) * x));
  const double kappa = kappa_of(equations);
  const double drag = (1 - kappa) * (dynamics.translational_drag + dynamics.quadratic_drag * speed) +
                      kappa * dynamics.rotational_drag;
  turning_bend = turning == 0 ? 0 : turning * (most + drag * speed + turning);
}

}  // namespace hybrid_sphere::numeric
