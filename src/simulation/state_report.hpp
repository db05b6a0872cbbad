#pragma once

#include <memory>

#include "hybrid_sphere/simulation/simulation.hpp"
#include "simulation/hybrid_state.hpp"

namespace hybrid_sphere {

/// What is told of the sphere at time(): State and reaction. They follow from the segment, or are held where
/// there is none.
class StateReport {
 public:
  /// @param hybrid, outlook  have to live as long as this
  StateReport(HybridState& hybrid, const detail::Outlook& outlook) : hybrid_(hybrid), outlook_(outlook) {}

  /// What is told, as update() or hold() have left it.
  State& state() { return state_; }
  const State& state() const { return state_; }
  /// The motion in force where it is one of constant twist and the state is not held: else null.
  const ConstantTwist* constant_twist() const { return constant_twist_; }

  /// Whether state and reaction are those of an instant, whatever becomes of the motion.
  bool is_held() const { return held_; }
  /// Whether, besides, there is no motion.
  bool is_detached() const { return detached_; }

  /// A segment has begun: they are what it says.
  void follow_segment();
  /// The next ground has yet to act: they are what the segment says, if there is one.
  void follow_segment_if_any();
  /// They are held as they were told last.
  void hold();
  /// Holds state and reaction at time(). Throws nothing.
  /// @param fallback  where the segment does not say them, if its numbers are finite; else what was told last
  void hold_at_present(const Segment::Start& fallback);
  /// There is no motion: the sphere stands in a state of its own, with the constraint in force.
  /// @param start  where one of its numbers is not finite, what was told last
  void stand(const Segment::Start& start);

  /// What the state says at a time of the segment: all of it, or nothing where that throws.
  void update(double tau);
  /// What does not change over a segment of constant twist.
  void note_velocities(const MotionState& now);
  /// Force of the ground at time(), from the segment [N].
  const Vector3d& update_reaction();
  const Vector3d& reaction() const { return reaction_; }

  /// Names the ground that has acted. @return what has to live as long as the name before is looked at
  std::shared_ptr<const Ground> name(RegionId region);
  /// Where no ground has acted yet, names the one under the sphere, if there is memory to look it up.
  void name_if_nameless();
  /// Whether the name is one of this ground.
  bool is_named_by(const std::shared_ptr<const Ground>& ground) const { return named_by_ == ground; }
  void forget_name() { state_.region = {}; }

 private:
  void set_held(bool held);
  void describe(ContactMode mode, const Twist& twist, const Vector2d& contact_velocity, bool at_rest,
                const Vector2d& position);
  Vector3d reaction_of(const PointState& center) const;

  HybridState& hybrid_;
  const detail::Outlook& outlook_;
  State state_;  // what a constant twist keeps is always up to date
  const ConstantTwist* constant_twist_ = nullptr;
  std::shared_ptr<const Ground> named_by_;  // keeps the name in the state
  Vector3d reaction_ = Vector3d::Zero();
  bool held_ = false;
  bool detached_ = false;
};

}  // namespace hybrid_sphere
