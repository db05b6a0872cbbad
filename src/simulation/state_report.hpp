#pragma once

#include <memory>

#include "hybrid_sphere/simulation/simulation.hpp"
#include "simulation/hybrid_state.hpp"

namespace hybrid_sphere {

/// State and reaction of the sphere at time(). They follow from the segment, or are held if there is none.
class StateReport {
 public:
  /// @param hybrid, outlook  must outlive this object
  StateReport(HybridState& hybrid, detail::Outlook& outlook) : hybrid_(hybrid), outlook_(outlook) {}

  /// The state as update() or hold() left it.
  State& state() { return outlook_.state; }
  const State& state() const { return outlook_.state; }

  /// Whether state and reaction are frozen at an instant, whatever happens to the motion.
  bool is_held() const { return held_; }
  /// Whether there is no motion either.
  bool is_detached() const { return detached_; }

  /// A segment has begun: takes state and reaction from it.
  void follow_segment();
  /// The next ground has yet to act: takes state and reaction from the segment, if there is one.
  void follow_segment_if_any();
  /// Holds state and reaction as last reported.
  void hold();
  /// Holds state and reaction at time(). Does not throw.
  /// @param fallback  used if the segment cannot give them and its numbers are finite; otherwise the last
  ///                  report is kept
  void hold_at_present(const Segment::Start& fallback);
  /// Holds a state, with the constraint in force, until a segment begins.
  /// @param start  if one of its numbers is not finite, the last report is kept
  void hold_at(const Segment::Start& start);
  /// There is no motion: the sphere stays in the given state, with the constraint in force.
  /// @param start  if one of its numbers is not finite, the last report is kept
  void stand(const Segment::Start& start);

  /// Updates the state to a time of the segment: entirely, or not at all if that throws.
  void update(double tau);
  /// Sets what does not change over a segment of constant twist.
  void note_velocities(const MotionState& now);
  /// Force of the ground at time(), from the segment [N].
  const Vector3d& update_reaction();
  const Vector3d& reaction() const { return reaction_; }

  /// Names the ground that has acted. @return the owner of the previous name, which keeps it valid
  std::shared_ptr<const Ground> name(RegionId region);
  /// If no ground has acted yet, names the one under the sphere, memory permitting.
  void name_if_nameless();
  /// Whether the name comes from this ground.
  bool is_named_by(const std::shared_ptr<const Ground>& ground) const { return named_by_ == ground; }
  void forget_name() { outlook_.state.region = {}; }

 private:
  void set_held(bool held);
  void describe(ContactMode mode, const Twist& twist, const Vector2d& contact_velocity, bool at_rest,
                const Vector2d& position);
  Vector3d reaction_of(const PointState& center) const;

  HybridState& hybrid_;
  detail::Outlook& outlook_;
  std::shared_ptr<const Ground> named_by_;  // keeps the name in the state
  Vector3d reaction_ = Vector3d::Zero();
  bool held_ = false;
  bool detached_ = false;
};

}  // namespace hybrid_sphere
