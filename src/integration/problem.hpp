#pragma once

#include <Eigen/Core>
#include <limits>

#include "hybrid_sphere/numerical_error.hpp"

namespace hybrid_sphere::integration {

using State = Eigen::Map<Eigen::VectorXd>;
using ConstState = Eigen::Map<const Eigen::VectorXd>;

/// An initial value problem y' = derivative(x, y). An exception of its functions ends the step that called
/// them and passes out of the integrator's step().
class Problem {
 public:
  virtual ~Problem() = default;

  virtual void derivative(double x, const ConstState& y, State& rate) = 0;

  /// Longest step from y.
  virtual double max_step(const ConstState& /*y*/) { return std::numeric_limits<double>::max(); }
};

/// The integrator gives up; what() is its reason.
class NoStep : public NumericalError {
 public:
  using NumericalError::NumericalError;
};

}  // namespace hybrid_sphere::integration
