#include "motion/choose_integrator.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace hybrid_sphere::numeric {
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

std::unique_ptr<integration::Integrator> make(Kind kind, const scene::Solver& solver) {
  using Formula = integration::Cvode::Formula;
  using Rule = integration::FixedStepRule;
  const double tolerance = tolerance_of_a_step(kind, solver.accuracy);
  switch (kind) {
    case Kind::automatic:
    case Kind::exact: break;
    case Kind::arkode_erk: return integration::make_erk(integration::prince_dormand(), tolerance);
    case Kind::arkode_erk5: return integration::make_erk(integration::dormand_prince(), tolerance);
    case Kind::arkode_erk3: return integration::make_erk(integration::bogacki_shampine(), tolerance);
    case Kind::cvode_adams: return integration::make_cvode(Formula::adams, tolerance);
    case Kind::cvode_bdf: return integration::make_cvode(Formula::bdf, tolerance);
    case Kind::dopri5: return integration::make_runge_kutta(integration::dormand_prince(), tolerance);
    case Kind::dopri87: return integration::make_runge_kutta(integration::prince_dormand(), tolerance);
    case Kind::euler: return integration::make_fixed_step(Rule::euler, solver.step);
    case Kind::lie_midpoint: return integration::make_fixed_step(Rule::midpoint, solver.step);
    case Kind::rk4:
    case Kind::rkmk4: return integration::make_fixed_step(Rule::rk4, solver.step);
  }
  throw std::logic_error("a numerical method without a name");
}

constexpr double finest_implicit = 1e-9;  // measured: docs/speed_and_accuracy.md

}  // namespace

bool turns_implicit(const scene::Solver& solver) {
  return solver.uses_closed_forms() && solver.accuracy >= finest_implicit;
}

std::unique_ptr<integration::Integrator> make_integrator(const scene::Solver& solver) {
  std::unique_ptr<integration::Integrator> method = make(chosen_method(solver), solver);
  if (!solver.uses_closed_forms()) return method;
  scene::Solver implicit = solver;
  constexpr double coarsest = 1e-3;  // that its estimates are good for
  implicit.accuracy = std::clamp(solver.accuracy, finest_implicit, coarsest);
  return integration::make_stiff_aware(std::move(method), make(Kind::cvode_bdf, implicit),
                                       turns_implicit(solver));
}

}  // namespace hybrid_sphere::numeric
