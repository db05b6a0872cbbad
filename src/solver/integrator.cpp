#include "hybrid_sphere/solver/integrator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "cvode_integrator.hpp"
#include "erk_integrator.hpp"
#include "fixed_step_integrator.hpp"
#include "odeint_integrator.hpp"
#include "stiff_aware_integrator.hpp"

namespace hybrid_sphere::solver {
namespace {

using Kind = scene::Solver::Method;

// Below the last figure, which rounding spoils, no tolerance can be held.
constexpr double least_tolerance = 1e-14;

// Errors of many steps add up; the less accurate a step, the more there are. Measured:
// docs/speed_and_accuracy.md.
double share_of_a_step(Kind kind) {
  switch (kind) {
    case Kind::cvode_adams: return 5e-4;
    case Kind::cvode_bdf: return 5e-5;
    case Kind::arkode_erk3: return 1e-3;
    case Kind::arkode_erk5:
    case Kind::dopri5: return 5e-3;
    default: return 0.02;
  }
}

}  // namespace

Kind chosen_method(const scene::Solver& solver) {
  constexpr double worth_high_order = 1e-6;
  if (!solver.uses_closed_forms()) return solver.method;
  return solver.accuracy < worth_high_order ? Kind::dopri87 : Kind::dopri5;
}

namespace {

double tolerance_of_a_step(Kind kind, double accuracy) {
  return std::max(share_of_a_step(kind) * accuracy, least_tolerance);
}

std::unique_ptr<Integrator> make(Kind kind, const scene::Solver& solver) {
  using Formula = integration::Cvode::Formula;
  using Rule = FixedStepIntegrator::Rule;
  const double tolerance = tolerance_of_a_step(kind, solver.accuracy);
  switch (kind) {
    case Kind::automatic:
    case Kind::exact: break;
    case Kind::arkode_erk: return std::make_unique<ErkIntegrator>(integration::prince_dormand(), tolerance);
    case Kind::arkode_erk5: return std::make_unique<ErkIntegrator>(integration::dormand_prince(), tolerance);
    case Kind::arkode_erk3:
      return std::make_unique<ErkIntegrator>(integration::bogacki_shampine(), tolerance);
    case Kind::cvode_adams: return std::make_unique<CvodeIntegrator>(Formula::adams, tolerance);
    case Kind::cvode_bdf: return std::make_unique<CvodeIntegrator>(Formula::bdf, tolerance);
    case Kind::dopri5: return make_dopri5(tolerance);
    case Kind::dopri87: return make_dopri87(tolerance);
    case Kind::euler: return std::make_unique<FixedStepIntegrator>(Rule::euler, solver.step);
    case Kind::lie_midpoint: return std::make_unique<FixedStepIntegrator>(Rule::midpoint, solver.step);
    case Kind::rk4:
    case Kind::rkmk4: return std::make_unique<FixedStepIntegrator>(Rule::rk4, solver.step);
  }
  throw std::logic_error("a numerical method without a name");
}

}  // namespace

namespace {

constexpr double finest_implicit = 1e-9;  // measured: docs/speed_and_accuracy.md

}  // namespace

bool turns_implicit(const scene::Solver& solver) {
  return solver.uses_closed_forms() && solver.accuracy >= finest_implicit;
}

std::unique_ptr<Integrator> make_integrator(const scene::Solver& solver) {
  std::unique_ptr<Integrator> method = make(chosen_method(solver), solver);
  if (!solver.uses_closed_forms()) return method;
  scene::Solver implicit = solver;
  constexpr double coarsest = 1e-3;  // that its estimates are good for
  implicit.accuracy = std::clamp(solver.accuracy, finest_implicit, coarsest);
  return std::make_unique<StiffAwareIntegrator>(std::move(method), make(Kind::cvode_bdf, implicit),
                                                turns_implicit(solver));
}

double error_of_better(double difference, int order) {
  return difference * std::min(1.0, std::pow(difference, 1.0 / order));
}

// abs(v) v has a corner at v = 0, which a method's error estimate, a difference of slopes within a step, does
// not see from afar. So v may not halve in a step, unless the step is so short that the corner, of the size
// c a^2 h^3, is below the tolerance.
double max_step(const Equations& equations, const State& y, double allowed_speed_error) {
  const double drag = equations.dynamics().quadratic_drag;
  const double pace = equations.pace(y);
  const double longest = max_time / pace;
  if (drag == 0) return longest;
  const Instant now = equations.instant(y);
  const double acceleration = equations.acceleration(y, now).norm();
  if (acceleration == 0) return longest;
  const double blurred = std::cbrt(allowed_speed_error / drag / acceleration / acceleration);
  return std::min(std::max(0.5 * now.velocity.norm() / acceleration, blurred) / pace, longest);
}

// In x what lies across w decays with the rate A. A path along a line has nothing there that an error
// estimate would see, until a rounding is multiplied by about (A h)^p/p! in each step.
double max_explicit_step(const Equations& equations, const State& y, double allowed_speed_error) {
  constexpr double stable = 8;
  const double longest = max_step(equations, y, allowed_speed_error);
  const double decay = equations.decays();
  return decay * longest > stable ? stable / decay : longest;
}

}  // namespace hybrid_sphere::solver
