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
  FlowState slope = FlowState::Zero();  ///< dy/dx, where a method of fixed step keeps it
  /// What else the method knows of the step to the next node, or of the one that ended here.
  std::vector<FlowState> shape{};
  bool implicit = false;  ///< whether an implicit method, of two, took the step that ended here
  double bend =
      0;  ///< of a method with step paths: bound on the bend of the way over the step that ended here
  double bends = 0;  ///< the greatest of the last 2^n steps, where 2^n divides the number of this node
};

/// A numerical method: takes the steps of a solution of a Flow and says what lies between them.
class Integrator {
 public:
  virtual ~Integrator() = default;

  /// Length in x of the first step to try.
  /// @param longest  on which the equations may change, > 0
  virtual double first_step(const Flow& /*flow*/, const FlowState& /*y*/, double longest) { return longest; }

  /// @param flow        has to live as long as the method is used
  /// @param first       with its state; the method adds the rest
  /// @param scale       size of each component to which errors are relative, > 0
  /// @param first_step  trial length of the first step in x, > 0; not for methods of fixed step
  virtual void begin(const Flow& flow, Node& first, const FlowState& scale, double first_step) = 0;

  /// Takes one step.
  /// @param from   the last node; its step is set
  /// @param scale  for this step
  /// Throws NumericalError with the reason if there is no step.
  virtual Node step(Node& from, const FlowState& scale) = 0;

  /// The state a length x after `from`, 0 <= x <= from.step; `to` is the node after it. The same whatever has
  /// been asked for before: `from` only keeps what would have to be computed again.
  virtual FlowState interpolate(Node& from, const Node& to, double x) = 0;

  /// Whether the way between two nodes is that of a StepPath, and not within the tolerance of the integral of
  /// the velocities there.
  virtual bool has_step_paths() const { return false; }

  /// Estimated error that the last step has added, relative to the scale, the greatest of its components.
  virtual double last_error() = 0;
  /// Error of a step that a state may have beside that of the method: what end of a motion is too small to be
  /// followed. Relative to the scale of motion.
  virtual double tolerance() const = 0;
  /// What is left of a velocity that neither dies nor grows and need not be followed any more.
  /// @param speed  of the motion
  virtual double negligible(double speed) const { return tolerance() * speed; }
  /// So many states the shape of a node has at most.
  virtual std::size_t largest_shape() const = 0;
  virtual std::uint64_t evaluations() const = 0;  ///< of the right-hand side
};

/// The local error of a method, told by its difference from one of one order less: the differences are that
/// one's errors. A step in which both series converge alike has errors C h^p and C h^(p + 1).
/// @param difference  relative to the scale of motion
/// @param order       p, of the better method
double error_of_better(double difference, int order);

}  // namespace hybrid_sphere::integration
