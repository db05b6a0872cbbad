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

  /// Called with y at the end of each accepted step: puts it back onto what the motion must satisfy.
  virtual void finish_step(double /*x*/, State& /*y*/) {}

  /// Number of functions whose sign changes end a step early.
  virtual int roots() const { return 0; }
  virtual void root_functions(double /*x*/, const ConstState& /*y*/, double* /*values*/) {}
};

/// The integrator gives up; what() is its reason.
class NoStep : public NumericalError {
 public:
  using NumericalError::NumericalError;
};

/// Where an integrator stopped.
struct Step {
  double x = 0;          ///< reached
  bool at_root = false;  ///< y belongs to a root, interpolated: only near it
  bool complete = true;  ///< x is the end of the step; otherwise the next call continues within it
};

}  // namespace hybrid_sphere::integration
