#pragma once

#include <memory>

#include "hybrid_sphere/numerical_error.hpp"
#include "motion/attitude.hpp"
#include "motion/dry_friction_motion.hpp"
#include "motion/dry_friction_series.hpp"
#include "motion/edge_slide.hpp"
#include "motion/linear_motion.hpp"
#include "motion/linear_series.hpp"
#include "motion/numeric_motion.hpp"
#include "motion/numeric_series.hpp"
#include "motion/straight_slide.hpp"
#include "motion/uniform_motion.hpp"
#include "simulation/motion_kind.hpp"

namespace hybrid_sphere {

/// Target error of the orientation, relative to the angle turned: a fiftieth of the accuracy, like that of
/// the steps of an integration; along a closed form, rounding if no more than the default is allowed. Source:
/// docs/theory.md 6.
/// @param accuracy  of the solver
double spin_accuracy(double accuracy, bool closed_form);

/// The motion between two switches: the simplest one that the ground and the forces in force allow. The
/// choice is made once, when the segment begins: docs/theory.md 4.7.
class Segment {
 public:
  /// The state with which a segment begins.
  struct Start {
    Vector2d position;
    Quaterniond orientation;
    Twist twist;
    Vector2d contact_velocity;  ///< sigma, exact where it is known to be that of the ground [m/s]
    /// Whether the limit of what the ground can hold may be exceeded by a relative 2^-30, because rounding
    /// hides whether it is.
    bool loose = false;
  };

  Segment(const Dynamics& dynamics, const scene::Solver& solver);
  Segment(const Segment&) = delete;
  Segment& operator=(const Segment&) = delete;

  /// Changes the forces; a new segment must begin afterwards.
  void set_dynamics(const Dynamics& dynamics);
  const Dynamics& dynamics() const { return dynamics_; }
  /// Takes effect with the next segment.
  void set_accuracy(double accuracy);
  /// Whether the orientation is computed, from the next segment on; otherwise it stays as it is.
  void follow_orientation(bool follow) { follows_orientation_ = follow; }
  /// Whether the motion is integrated numerically.
  bool integrates() const { return motion_->is_integrated(); }

  /// @param first  how far it is followed at first, > 0 [s]
  void begin(ContactMode mode, const scene::Material& material, const Start& start, double first = never);

  /// @param slide  along the edge from which the sphere is let go into `first` or `second`
  void begin_edge_slide(const EdgeSlide& slide, const Start& start);

  /// Whether a new segment with these would only continue the present motion.
  bool continues(ContactMode mode, const scene::Material& material) const;
  /// Continues the motion under another name.
  void continue_as(ContactMode mode, const scene::Material& material) {
    mode_ = mode;
    material_ = material;
  }

  Motion& motion() { return *motion_; }
  /// Whether both velocities are constant: the motion is uniform_motion().
  bool uniform() const { return is_uniform_; }
  const UniformMotion& uniform_motion() const { return uniform_; }
  const EdgeSlide& edge_slide() const { return edge_slide_; }
  ContactMode mode() const { return mode_; }
  /// The ground in force.
  const scene::Material& material() const { return material_; }
  /// Time in which forces change the velocities of a motion that is not uniform; `never` if there are none
  /// [s].
  double time_scale() const { return time_scale_; }
  /// Sum of the speeds of centre and contact with which a motion that is not uniform began [m/s].
  double first_speed() const { return first_twist_.velocity.norm() + first_contact_velocity_.norm(); }

  MotionState at(double tau) { return motion_->at(tau); }
  /// The same, but at the beginning it returns the segment's initial velocities to the bit: a motion may keep
  /// sums of them, such as the slip, whose rounding exceeds a small velocity.
  MotionState told_at(double tau);
  /// The same to rounding, at less cost where many are asked for.
  MotionState output_at(double tau) { return tau > 0 ? outputs_->at(tau) : told_at(tau); }
  Quaterniond orientation(double tau) {
    return is_uniform_ ? uniform_.orientation(tau) : attitude_.at(tau, *outputs_);
  }
  /// Ensures that at() and orientation() can be evaluated up to a time. Throws NumericalError with the reason
  /// if the motion cannot be followed that far; what was known before stays known.
  void reach(double tau);
  /// Time up to which the motion is known; `never` if for all times [s].
  double reached() const;
  /// Promises that no time before tau will be requested, so that earlier data can be dropped.
  void forget_before(double tau);
  /// Whether nothing has been forgotten yet.
  bool is_whole() const { return is_whole_; }

  /// Why the motion ended.
  MotionEnd end_reason() const { return motion_->end_reason(); }

  const scene::Solver& solver() const { return solver_; }

  /// Number of right-hand sides evaluated so far, in all segments.
  std::uint64_t evaluations() const { return numeric_ ? numeric_->evaluations() : 0; }
  /// Whether a motion has been integrated.
  bool has_integrated() const { return numeric_ != nullptr; }
  /// Estimated error of all steps so far: of the integrations, relative to the scale of motion, and of the
  /// orientation, relative to the angle turned. Both are sums over all segments since forget_errors().
  double estimated_error() const;
  /// Ends the motion, too: a new segment must begin.
  void forget_errors();

 private:
  /// Errors of the orientation in the segments before this one, and the angles turned in them [rad].
  struct Turned {
    double error = 0;
    double angle = 0;
  };
  Turned turned() const;

  void set_motion(Motion& motion, bool is_uniform = false) {
    motion_ = outputs_ = &motion;
    is_uniform_ = is_uniform;
  }
  NormalSpin normal_spin(ContactMode mode, const scene::Material& material, double omega_3) const;
  void begin_linear(const Start& start, const NormalSpin& spin);
  void set_linear_motion(const Start& start, const NormalSpin& spin);
  void begin_dry_friction(const Start& start, const NormalSpin& spin);
  bool begin_straight(const Start& start, const NormalSpin& spin);
  void begin_numeric(const Start& start, const NormalSpin& spin);
  void begin_numeric_slide(const Start& start, const NormalSpin& spin);
  Vector2d rolling_velocity(const Start& start) const;
  Vector2d slip(const Start& start) const;
  Vector2d conserved_velocity(const Start& start) const;
  SpinProfile spin_profile(const Start& start) const;
  double find_time_scale(const Start& start) const;
  void follow_to_failure();
  double pulls() const;
  double lazy_until() const;
  double turned_in_a_round(double period);
  double find_lazy_time(const Start& start, const SpinProfile& profile);
  void begin_attitude(const Start& start, const SpinProfile& profile);

  Dynamics dynamics_;
  scene::Solver solver_;
  ContactMode mode_ = ContactMode::free;
  double time_scale_ = never;
  // Until then the orientation is followed only on request: for a closed form, or at rest [s].
  double lazy_until_ = never;
  bool is_whole_ = true;
  bool follows_orientation_ = true;
  scene::Material material_;
  Twist first_twist_;
  Vector2d first_contact_velocity_ = Vector2d::Zero();
  UniformMotion uniform_;
  Motion* motion_ = &uniform_;
  Motion* outputs_ = &uniform_;  // the same to rounding, at less cost for many times
  bool is_uniform_ = true;
  LinearMotion linear_;
  LinearSeries linear_series_;
  DryFrictionMotion dry_;
  DryFrictionSeries dry_series_;
  StraightSlide straight_;
  EdgeSlide edge_slide_;
  std::unique_ptr<NumericMotion> numeric_;  // created on first use
  NumericSeries numeric_series_;
  Attitude attitude_;
  Turned turned_before_;
};

}  // namespace hybrid_sphere
