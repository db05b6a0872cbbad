#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "hybrid_sphere/numerical_error.hpp"
#include "integration/flow.hpp"

namespace hybrid_sphere::integration {

/// A state at which a step begins or ends.
struct Node {
  FlowState y = FlowState::Zero();
  double step = 0;                      ///< in x, to the next node
  FlowState slope = FlowState::Zero();  ///< dy/dx, kept by methods of one step
  /// What else the method knows about the step to the next node.
  std::vector<FlowState> shape{};
  bool implicit = false;  ///< whether, of two methods, the implicit one took the step that ended here
  double bend =
      0;  ///< of a method with step paths: bound on the bend of the way over the step that ended here
  double bends = 0;  ///< the greatest of the last 2^n steps, where 2^n divides the number of this node
};

/// A numerical method: takes the steps of a solution of a Flow and interpolates between them.
class Integrator {
 public:
  virtual ~Integrator() = default;

  /// Length in x of the first step to try.
  /// @param longest  on which the equations may change, > 0
  virtual double first_step(const Flow& /*flow*/, const FlowState& /*y*/, double longest) { return longest; }

  /// @param flow        must live as long as the method is used
  /// @param first       with its state set; the method fills in the rest
  /// @param scale       size of each component to which errors are relative, > 0
  /// @param first_step  trial length of the first step in x, > 0; not for methods of fixed step
  virtual void begin(const Flow& flow, Node& first, const FlowState& scale, double first_step) = 0;

  /// Takes one step.
  /// @param from   the last node; its step is set
  /// @param scale  for this step
  /// Throws NumericalError with the reason if there is no step.
  virtual Node step(Node& from, const FlowState& scale) = 0;

  /// The state at a length x after `from`, 0 <= x <= from.step; `to` is the next node. Independent of earlier
  /// requests: `from` only caches what would have to be recomputed.
  virtual FlowState interpolate(Node& from, const Node& to, double x) = 0;

  /// Whether the path between two nodes is a StepPath, and so not within tolerance of the integral of the
  /// velocities there.
  virtual bool has_step_paths() const { return false; }

  /// Estimated error that the last step has added, relative to the scale, the greatest of its components.
  virtual double last_error() = 0;
  /// Error that a state may have besides the method's error in a step: the remainder of a motion that is too
  /// small to be followed. Relative to the scale of motion.
  virtual double tolerance() const = 0;
  /// Remainder of a velocity that neither decays nor grows and need not be followed any further.
  /// @param speed  of the motion
  virtual double negligible(double speed) const { return tolerance() * speed; }
  /// Maximum number of states in the shape of a node.
  virtual std::size_t largest_shape() const = 0;
  virtual std::uint64_t evaluations() const = 0;  ///< of the right-hand side
};

/// The local error of a method, estimated from its difference to a method of one order less: the differences
/// are the errors of the latter. A step in which both series converge alike has errors C h^p and C h^(p + 1).
/// @param difference  relative to the scale of motion
/// @param order       p, of the better method
double error_of_better(double difference, int order);

}  // namespace hybrid_sphere::integration
