#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "integration/runge_kutta.hpp"
#include "mechanics/constrained_motion.hpp"
#include "mechanics/implicit_step.hpp"

namespace hybrid_sphere::mechanics {

/// A state of a segment: x is the time since the beginning of the segment [s], y holds q and v (N + n).
struct Node {
  double x = 0;
  Vector y;
  std::shared_ptr<const ImplicitStart> implicit = nullptr;  ///< if the step from here is implicit
  KeptRows::Rows rows = nullptr;                            ///< of C, by which the step from here goes
  double error = 0;                                         ///< estimated, up to here: ErrorSum
};

/// Steps along a motion under the constraints that hold, projected back onto them at their ends: of Prince's
/// and Dormand's method, or implicit ones where the node they start from says so. All functions throw
/// ConstraintError and NotFinite, and StepError where the equations of an implicit step are not solved.
class MotionStep {
 public:
  /// @param motion  must outlive this object
  explicit MotionStep(ConstrainedMotion& motion) : motion_(&motion) {}

  using Function = std::function<double()>;
  /// What is integrated beside the motion.
  struct Beside {
    std::vector<const Guard*> guards;  // by their rates
    std::vector<Function> functions;   // values at the state at which the motion has been evaluated last
    Index size() const { return static_cast<Index>(guards.size() + functions.size()); }
  };

  /// The state at x, one step after a node.
  /// @param start  t at x = 0 [s]
  Node reach(double start, const Node& from, double x);

  /// The next steps are from this node, at which the motion has been evaluated.
  /// @param beside  must live as long as steps are taken
  void begin(double start, const Node& from, Beside beside);
  /// The Jacobian of the rates of q and v at that node (N + n)^2. Evaluates the motion N + n times.
  /// @param scale  of q and v (N + n)
  Eigen::MatrixXd linearize(const Vector& scale);
  /// Chooses the method of the next steps from that node: implicit, unless null.
  void use(std::shared_ptr<const ImplicitStart> start) { from_.implicit = std::move(start); }
  /// @return  the node a length h further [s]
  Node take(double h);

  // Of the step taken last:
  /// To what the embedded method gives, of q, v and the guards.
  void difference(Vector& difference);
  /// Of the end, before the projection, to the state of the last stage, which is at the end, too: of the
  /// number i of q and v.
  double difference_of_last_stage(Index i) const;
  /// At the end, before the projection: slips that should not be there.
  const std::vector<SlidingFriction::Across>& slips_across() const { return slips_across_; }
  /// At the end, before the projection: slips in a plane.
  const std::vector<SlidingFriction::Speed>& slip_speeds() const { return slip_speeds_; }
  /// By how much the projection onto the constraints has moved the number i of q and v.
  double projection(Index i) const;
  /// Of an explicit step: by its last two stages, the rate at which velocities that differ change their
  /// difference [1/s]; 0 where that is rounding. @param scale  of q and v (N + n)
  double fast_rate(const Vector& scale) const;
  /// Of an implicit step: how fast Newton's iterations converge; 0 at once, 1 not at all.
  double contraction() const { return implicit_.contraction(); }
  /// The state at x, to the order 5: by both ends with their slopes, and a stage between them, or by
  /// collocation (N + n).
  void interpolate(double x, Vector& y) const;

 private:
  using Room = integration::RungeKutta::Room;

  ImplicitStep::Derivative derivative(double start, const Beside& beside);
  void set_slope(double t, const Beside& beside, Eigen::Ref<Eigen::VectorXd> slope) const;
  void split(const Eigen::VectorXd& y);
  void aim(double start, const Node& from);
  Eigen::VectorXd slope_by_turn(SlidingFriction::Held& friction, std::size_t place);
  void evaluate(double t, const Eigen::VectorXd& y);
  Node project(double start, double x, const Eigen::VectorXd& y);
  void see_slips();

  ConstrainedMotion* motion_;
  std::optional<Room> room_;   // of steps that are kept
  std::optional<Room> other_;  // of others
  ImplicitStep implicit_;      // likewise
  ImplicitStep other_implicit_;
  Beside beside_;
  double start_ = 0;
  double h_ = 0;
  Node from_;
  Vector y_;    // of it, with the guards
  Vector end_;  // projected
  std::vector<SlidingFriction::Across> slips_across_;
  std::vector<SlidingFriction::Speed> slip_speeds_;
  Vector q_;
  Vector v_;
};

}  // namespace hybrid_sphere::mechanics
