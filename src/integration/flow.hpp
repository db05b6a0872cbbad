#pragma once

#include <Eigen/Core>

namespace hybrid_sphere::integration {

/// The state of a Flow. Components 2 and 3 are a place, which may grow without bound.
using FlowState = Eigen::Array<double, 8, 1>;

/// Autonomous equations dy/dx = f(y) with the time as part of y, and what else a method needs to know about
/// them. x is any variable in which they are smooth.
class Flow {
 public:
  virtual ~Flow() = default;

  virtual FlowState derivative(const FlowState& y) const = 0;

  /// Length in x of a first step of order 1.
  /// @param tolerance  of the step, relative
  /// @param longest    on which the equations may change, > 0
  virtual double first_step(const FlowState& y, double tolerance, double longest) const = 0;
  /// Length in x of a step that takes a given time, or part of the time for which the equations hold.
  /// @param duration  [s]
  virtual double step_of_time(const FlowState& y, double duration) const = 0;

  /// Longest step from y in which a method still sees all that the equations do, and which ends at a time
  /// that can be requested.
  /// @param allowed_speed_error  [m/s]
  virtual double max_step(const FlowState& y, double allowed_speed_error) const = 0;
  /// The same for an explicit method, which in longer steps amplifies what lies across a slip, even if that
  /// is no more than rounding.
  virtual double max_explicit_step(const FlowState& y, double allowed_speed_error) const = 0;

  /// Whether a step of that length from y is this short only for the stability of an explicit method, because
  /// of drag or dry friction.
  virtual bool is_stiff_by_drag(const FlowState& y, double step) const = 0;
  virtual bool is_stiff_by_friction(const FlowState& y, double step) const = 0;

  /// Bound on the acceleration by dry friction; 0 without it [m/s^2].
  virtual double decays() const = 0;

 protected:
  Flow() = default;
  Flow(const Flow&) = default;
  Flow& operator=(const Flow&) = default;
};

}  // namespace hybrid_sphere::integration
