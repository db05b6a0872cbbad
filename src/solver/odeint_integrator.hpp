#pragma once

#include <memory>

#include "hybrid_sphere/solver/integrator.hpp"

/// Boost.odeint's embedded Runge-Kutta methods with its own control of the step; all of it is inlined for
/// states of a size that is known, so that little is added to the right-hand sides. Between two nodes lies
/// DenseOutput through shorter steps. `tolerance` is that of a step, relative to the scale.
namespace hybrid_sphere::solver {

/// Dormand and Prince, order 5(4), 7 stages.
std::unique_ptr<Integrator> make_dopri5(double tolerance);

/// Prince and Dormand, order 8(7), 13 stages: integration::prince_dormand().
std::unique_ptr<Integrator> make_dopri87(double tolerance);

}  // namespace hybrid_sphere::solver
