#pragma once

#include "hybrid_sphere/integration/problem.hpp"
#include "hybrid_sphere/solver/integrator.hpp"

namespace hybrid_sphere::solver {

/// Equations as SUNDIALS sees them.
class AdaptiveProblem final : public integration::Problem {
 public:
  void derivative(double /*x*/, const integration::ConstState& y, integration::State& rate) override {
    rate = unit * equations->derivative(y.array()).matrix();
  }
  double max_step(const integration::ConstState& y) override {
    const auto longest = is_explicit ? max_explicit_step : solver::max_step;
    return longest(*equations, y.array(), allowed_speed_error) / unit;
  }

  const Equations* equations = nullptr;
  double allowed_speed_error = 0;  ///< [m/s]
  bool is_explicit = false;        ///< the method
  double unit = 1;                 ///< of x, a power of two
};

}  // namespace hybrid_sphere::solver
