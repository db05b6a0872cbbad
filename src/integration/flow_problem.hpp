#pragma once

#include "integration/integrator.hpp"
#include "integration/problem.hpp"

namespace hybrid_sphere::integration {

/// A Flow as SUNDIALS sees it.
class FlowProblem final : public Problem {
 public:
  void derivative(double /*x*/, const ConstState& y, State& rate) override {
    rate = unit * flow->derivative(y.array()).matrix();
  }
  double max_step(const ConstState& y) override {
    const double longest = is_explicit ? flow->max_explicit_step(y.array(), allowed_speed_error)
                                       : flow->max_step(y.array(), allowed_speed_error);
    return longest / unit;
  }

  const Flow* flow = nullptr;
  double allowed_speed_error = 0;  ///< [m/s]
  bool is_explicit = false;        ///< the method
  double unit = 1;                 ///< of x, a power of two
};

}  // namespace hybrid_sphere::integration
