#pragma once

#include <memory>

#include "integration/cvode.hpp"
#include "integration/integrator.hpp"
#include "integration/tableau.hpp"

/// The numerical methods. `tolerance` is that of a step, relative to the scale.
namespace hybrid_sphere::integration {

/// ARKODE's explicit Runge-Kutta methods.
std::unique_ptr<Integrator> make_erk(const Tableau& tableau, double tolerance);
/// CVODE's multistep methods.
std::unique_ptr<Integrator> make_cvode(Cvode::Formula formula, double tolerance);
/// Steps of RungeKutta.
std::unique_ptr<Integrator> make_runge_kutta(const Tableau& tableau, double tolerance);

/// Fixed-length steps without error control.
enum class FixedStepRule { euler, midpoint, rk4 };
/// @param step  [s], > 0
std::unique_ptr<Integrator> make_fixed_step(FixedStepRule rule, double step);

/// Uses the explicit method until the motion becomes stiff, then the implicit one.
/// @param for_drag  whether the implicit method is accurate enough to be worthwhile for drag; for dry
///                  friction there is no alternative
std::unique_ptr<Integrator> make_stiff_aware(std::unique_ptr<Integrator> explicit_method,
                                             std::unique_ptr<Integrator> implicit_method, bool for_drag);

}  // namespace hybrid_sphere::integration
