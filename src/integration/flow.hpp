#pragma once

#include <Eigen/Core>

namespace hybrid_sphere::integration {

/// The state of a Flow. Components 2 and 3 are a place, which may grow without bound.
using FlowState = Eigen::Array<double, 8, 1>;

/// Autonomous equations dy/dx = f(y) with the time as part of y, and what a method has to know of them
/// besides. x is any variable in which they are smooth.
class Flow {
 public:
  virtual ~Flow() = default;

  virtual FlowState derivative(const FlowState& y) const = 0;

  /// Length in x of a first step of order 1.
  /// @param tolerance  of the step, relative
  /// @param longest    on which the equations may change, > 0
  virtual double first_step(const FlowState& y, double tolerance, double longest) const = 0;
  /// Length in x of a step that takes a given time, or a part of the time that the equations last.
  /// @param duration  [s]
  virtual double step_of_time(const FlowState& y, double duration) const = 0;

  /// No longer step from y lets a method see all that the equations do, or ends at a time that can be asked
  /// for.
  /// @param allowed_speed_error  [m/s]
  virtual double max_step(const FlowState& y, double allowed_speed_error) const = 0;
  /// The same of an explicit method, which multiplies what lies across a slip, though it be no more than
  /// rounding, where it takes longer steps.
  virtual double max_explicit_step(const FlowState& y, double allowed_speed_error) const = 0;

  /// Whether a step of that length from y is as short as it is for an explicit method's stability alone, by
  /// drag or by dry friction.
  virtual bool is_stiff_by_drag(const FlowState& y, double step) const = 0;
  virtual bool is_stiff_by_friction(const FlowState& y, double step) const = 0;

  /// Bound on what dry friction changes velocities by; 0 without it [m/s^2].
  virtual double decays() const = 0;

 protected:
  Flow() = default;
  Flow(const Flow&) = default;
  Flow& operator=(const Flow&) = default;
};

}  // namespace hybrid_sphere::integration
