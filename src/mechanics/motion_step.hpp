#pragma once

#include <optional>
#include <vector>

#include "integration/runge_kutta.hpp"
#include "mechanics/constrained_motion.hpp"

namespace hybrid_sphere::mechanics {

/// A state of a segment: x is the time since the beginning of the segment [s], y holds q and v (N + n).
struct Node {
  double x = 0;
  Vector y;
};

/// Steps of Prince's and Dormand's method along a motion under the constraints that hold, projected back onto
/// them at their ends. All functions throw ConstraintError and NotFinite.
class MotionStep {
 public:
  /// @param motion  must outlive this object
  explicit MotionStep(ConstrainedMotion& motion) : motion_(&motion) {}

  /// The state at x, one step after a node.
  /// @param start  t at x = 0 [s]
  Node reach(double start, const Node& from, double x);

  /// The next steps are from this node, at which the motion has been evaluated.
  /// @param guards  functions that are integrated beside the motion; must live as long as steps are taken
  void begin(double start, const Node& from, std::vector<const Guard*> guards);
  /// @return  the node a length h further [s]
  Node take(double h);

  // Of the step taken last:
  /// To what the embedded method gives, of q, v and the guards.
  void difference(Vector& difference) const;
  /// Of the end, before the projection, to the state of the last stage, which is at the end, too (N + n).
  Vector difference_of_last_stage() const;
  /// The state at x, to the order 5: by both ends with their slopes, and a stage between them (N + n).
  void interpolate(double x, Vector& y) const;

 private:
  using Room = integration::RungeKutta::Room;

  void set_slope(double t, const std::vector<const Guard*>& guards, Eigen::Ref<Eigen::VectorXd> slope) const;
  void split(const Eigen::VectorXd& y);
  void evaluate(double t, const Eigen::VectorXd& y);
  Node project(double start, double x, const Eigen::VectorXd& y);

  ConstrainedMotion* motion_;
  std::optional<Room> room_;   // of steps that are kept
  std::optional<Room> other_;  // of others
  std::vector<const Guard*> guards_;
  double start_ = 0;
  double h_ = 0;
  Node from_;
  Vector y_;    // of it, with the guards
  Vector end_;  // projected
  Vector q_;
  Vector v_;
};

}  // namespace hybrid_sphere::mechanics
