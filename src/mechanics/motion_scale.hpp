#pragma once

#include "mechanics/constrained_motion.hpp"

namespace hybrid_sphere::mechanics {

/// Sizes of the numbers from which coordinates and velocities are computed.
struct Sizes {
  Vector q;  // (N)
  Vector v;  // (n)
};

/// The scale of a motion at its start. A velocity counts with the speed that it has when it holds all kinetic
/// energy; at rest, with a small part of the speed that the forces give to it within `time`. A coordinate
/// counts with its own size, and with the distance covered at this speed within `time`.
/// @param time  a small part of the duration [s]; 0: without the forces
/// Throws NotFinite. Source: docs/theory.md 7.6.
Sizes sizes_at_start(const Model& model, double t, const Vector& q, const Vector& v, double time);

/// Sizes of the numbers from which q' is computed (N). @param speeds  Sizes::v (n)
Vector sizes_of_rate(const Model& model, const Vector& q, const Vector& speeds);

/// The scale of a motion, to which errors are relative. One for a whole solution, independent of units.
/// Velocities: the speed of a velocity that carries all kinetic energy that the motion has had; of one
/// without mass, as far as the constraints allow. Coordinates: the distance covered, but no more than they
/// cover before the motion turns. Source: docs/theory.md 7.5.
class MotionScale {
 public:
  MotionScale(const Model& model, const Vector& q);

  /// Updates the scale with a state. @param motion  evaluated there @param step  length of the next step, or
  /// a guess [s]
  void see(const ConstrainedMotion& motion, const Vector& q, const Vector& v, double step);

  /// Before any state has had a velocity: a step leads to this speed, in the metric of M, which may be more
  /// than the acceleration at its start says, where forces just cancel.
  void expect(const ConstrainedMotion& motion, const Vector& q, double speed, double step);

  /// What a fast damper has done is over: the turning time depends on accelerations from now on alone, and
  /// steps may be longer than the greatest speed would be kept.
  void forget_accelerations() {
    acceleration_ = 0;
    is_slow_ = true;
  }
  /// Steps are short again.
  void expect_short_steps() { is_slow_ = false; }

  /// Of q and v stacked (N + n); > 0.
  const Vector& values() const { return values_; }
  /// Whether any state so far had a velocity.
  bool has_moved() const { return speed_ > 0; }
  /// The greatest speed so far, in the metric of M.
  double speed() const { return speed_; }
  /// Time in which the velocity changes by its own size [s]; infinite without acceleration.
  double turning_time() const { return turning_time_; }
  /// The same by the acceleration of the last state alone.
  double present_turning_time() const { return present_turning_time_; }

 private:
  void set_velocities(const ConstrainedMotion& motion, double speed);
  void set_coordinates(const Vector& q, double step);

  const Model* model_;
  Vector start_;
  Vector displacement_;  // largest abs(q - q0)
  Vector velocity_;      // largest abs(v)
  Vector direction_;
  Vector rate_;
  Vector values_;
  double speed_ = 0;         // in the metric of M
  double expected_ = 0;      // speed for which values_ are
  double acceleration_ = 0;  // in the metric of M
  double turning_time_ = 0;
  double present_turning_time_ = 0;
  bool is_slow_ = false;
};

}  // namespace hybrid_sphere::mechanics
