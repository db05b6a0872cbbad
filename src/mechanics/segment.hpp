#pragma once

#include <memory>
#include <vector>

#include "hybrid_sphere/mechanics/solution.hpp"
#include "mechanics/error_sum.hpp"
#include "mechanics/motion_scale.hpp"
#include "mechanics/motion_step.hpp"

namespace hybrid_sphere::mechanics {

/// A motion under one set of constraints, from one switch to the next: accepted steps, each projected back
/// onto the constraints. Between two nodes the motion is one shorter step of the same method from the earlier
/// node, so that it does not depend on the requested times.
struct Segment {
  double start = 0;  ///< t at x = 0 [s]
  ActiveSet active;
  Slides sliding;
  std::vector<Node> nodes;  ///< ascending; the first one at x = 0, the last one at the end

  double duration() const { return nodes.back().x; }
  /// Resolution of the clock at x: 16 roundings of t and of x [s].
  double resolution(double x) const;
};

/// The state of a segment at x in [0, duration]; if the equations have no solution there, that of a later
/// node that the clock cannot distinguish from x. @param motion  with the active set of the segment
/// Throws ConstraintError, NotFinite.
Node state_at(const Segment& segment, double x, MotionStep& motion);

/// The requested error of a motion, by which its states are judged.
struct Precision {
  double accuracy = 0;
  Vector scale;  ///< of the coordinates (N)
};

/// The whole state at a time within a segment. @param status  of the motion: at its end the equations may
/// have no solution. Throws as Solution::at().
State state_of(const Model& model, const Segment& segment, double time, const Status& status,
               const Precision& precision);

/// A function that belongs to a constraint or an event, and whether it counts as positive until its sign
/// changes.
struct MonitoredGuard {
  enum class Kind {
    position,  ///< the guard of its schedule, g(t, q)
    reaction,  ///< lambda of a unilateral constraint that holds
    limit,     ///< mu_s N - abs(lambda) of a friction that holds
    slip,      ///< abs(f) of a friction that slides, up to the sign
    event      ///< the function of an event: `constraint` is its index in the model
  };
  std::size_t constraint = 0;
  bool positive = false;
  Kind kind = Kind::position;
  /// Rounding of an event's function if the segment begins on its zero; speed of a slip in a plane that has
  /// ended.
  double rounding = 0;
};

/// What the steps of a motion have cost.
struct Effort : ConstrainedMotion::Effort {
  std::uint64_t steps = 0;
};

/// The requirements on the steps of a motion.
struct StepDemand {
  double accuracy = 0;  ///< requested error of the motion, relative to MotionScale
  double duration = 0;  ///< of the motion [s]
  double max_step = 0;  ///< [s]
};

/// Takes the steps of segments, one after another, and finds where a guard changes sign.
class SegmentIntegrator {
 public:
  /// @param model  must outlive this object
  /// @param q      where the motion starts (N)
  SegmentIntegrator(const Model& model, const StepDemand& demand, const Vector& q);
  ~SegmentIntegrator();

  /// @param segment  with its start, active set and first node; must live until the next begin()
  /// @param guards   that are monitored
  /// @param end      the last x, > 0 [s]
  /// Throws ConstraintError, NotFinite.
  void begin(Segment& segment, std::vector<MonitoredGuard> guards, double end);

  /// Adds one node. @return  whether a guard has changed sign: the node is then the instant of the first
  /// change. Throws ConstraintError, NotFinite or StepError; the last node is then where the motion ends.
  bool advance();
  /// Those that have changed at that instant.
  const std::vector<MonitoredGuard>& passed() const;

  /// What the next steps depend on besides the segment.
  struct Memory {
    MotionScale scale;
    double step;  ///< length of the next one [s]; 0: not known
    ErrorSum errors;
  };
  Memory memory() const;
  /// @param node  where the motion goes on
  void restore(const Memory& memory, const Node& node);

  Effort effort() const;
  /// Length that the accuracy allows the next step [s]; 0 before the first one.
  double next_step() const;
  /// Estimated error at the last node.
  double estimated_error() const;
  /// Of the coordinates, so far; 0 before the first step (N).
  Vector position_scale() const;
  /// Near the last node, or at the start.
  Sizes sizes(double t, const Vector& q, const Vector& v) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hybrid_sphere::mechanics
