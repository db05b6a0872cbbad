#pragma once

#include <optional>

#include "hybrid_sphere/numerical_error.hpp"
#include "motion/friction_limit.hpp"
#include "motion/motion.hpp"
#include "motion/normal_spin.hpp"
#include "motion/slip_onset.hpp"
#include "motion/sticking_motion.hpp"
#include "motion/trajectory.hpp"

namespace hybrid_sphere {

/// Motion that is integrated numerically (motion/trajectory.hpp) in a time in which the equations are smooth
/// (motion/equations.hpp). Steps are taken only as far as a query needs; they, and hence all results, depend
/// on the beginning of the segment and the method alone. Members throw NumericalError, naming the time and
/// the reason, if the motion cannot be integrated further; a NaN is never returned. Internally lengths are in
/// a unit in which the greatest speed known at the beginning is about 1, so that squares and products of
/// small or large speeds stay normal numbers; the unit is a power of two, which costs no rounding. Source:
/// docs/theory.md 4.7, 4.8.
class NumericMotion final : public Motion {
 public:
  NumericMotion(const Dynamics& dynamics, const scene::Solver& solver);
  NumericMotion(const NumericMotion&) = delete;
  NumericMotion& operator=(const NumericMotion&) = delete;

  /// Takes effect with the next begin_...
  void set_dynamics(const Dynamics& dynamics) { dynamics_ = dynamics; }

  /// No force of the ground.
  void begin_free(const Vector2d& position, const Twist& twist, const NormalSpin& spin);
  /// sigma = u(r), no rolling resistance. On ground of the law coulomb it ends with the grip.
  void begin_rolling(const scene::Material& ground, const Vector2d& position, const Vector2d& velocity,
                     const NormalSpin& spin);
  /// Coulomb friction against the slip. A slip of 0 is allowed if abs(f - g - W J v) >= A up to rounding: the
  /// sphere starts to slide, or loses its grip.
  /// @param p_c   at the beginning, docs/theory.md 3.1 [m/s]; v = p_c + kappa (slip + u)
  /// @param slip  at the beginning [m/s]
  void begin_sliding(const scene::Material& ground, const Vector2d& position, const Vector2d& p_c,
                     const Vector2d& slip, const NormalSpin& spin);
  /// Rolling against a rolling resistance. nu = velocity - u(r) may be 0 if abs(B) >= A up to rounding.
  void begin_resisted_rolling(const scene::Material& ground, const Vector2d& position,
                              const Vector2d& velocity, const NormalSpin& spin);
  /// Sliding against a rolling resistance. Slip or nu, or both, may be 0 if friction does not hold them
  /// there, up to rounding: they start to grow.
  /// @param velocity  of the centre [m/s]
  /// @param nu        R (omega_2, -omega_1) [m/s]
  void begin_resisted_sliding(const scene::Material& ground, const Vector2d& position,
                              const Vector2d& velocity, const Vector2d& slip, const Vector2d& nu,
                              const NormalSpin& spin);
  /// Sliding while a rolling resistance keeps the sphere from turning: nu = 0. A slip of 0 is allowed as in
  /// begin_sliding.
  void begin_skidding(const scene::Material& ground, const Vector2d& position, const Vector2d& velocity,
                      const Vector2d& slip, const NormalSpin& spin);
  /// No force of the ground, and the rolling resistance keeps the sphere from turning: nu = 0.
  void begin_frictionless_skidding(const Vector2d& position, const Vector2d& velocity,
                                   const NormalSpin& spin);
  /// At rest relative to moving or forced ground, by rolling resistance.
  void begin_sticking(const scene::Material& ground, const Vector2d& position, const NormalSpin& spin);

  /// The reason for the end that end_before has found.
  MotionEnd end_reason() const override { return end_reason_; }
  SpinProfile spin_profile() const override;
  bool is_integrated() const override { return true; }

  MotionState at(double tau) override;
  PointState center(double tau) override;
  PointState path(double tau) override;
  /// Has no form, but gives the line if there is one.
  Curve curve() const override;
  Vector2d reference_velocity() override;
  double acceleration_bound(double from, double until) override;
  RapidChange rapid_change(double from, double until) override;
  /// @param horizon  finite [s]
  double end_before(double horizon) override;
  std::uint64_t steps(double from, double until) const override;
  /// Right-hand sides so far.
  std::uint64_t evaluations() const override { return trajectory_.evaluations(); }
  /// Estimated error of all motions so far, relative to the scale of motion.
  double estimated_error() const { return trajectory_.estimated_error(); }
  /// Whether steps are as long as an estimate of their error allows.
  bool estimates_errors() const { return !trajectory_.has_step_paths(); }
  /// Sets the accuracy and the method from the next motion on.
  void set_solver(const scene::Solver& solver) { trajectory_.set_solver(solver); }
  void forget_errors() { trajectory_.forget_errors(); }

  /// From when to when a step goes [s].
  struct Step {
    double from;
    double until;
  };
  /// The step in which a time lies; none where the motion is known without steps.
  std::optional<Step> step_at(double tau);

  /// Where the sphere rolls, gives it the angular velocity that goes with its velocities.
  void keep_rolling(MotionState& state) const;

  /// Takes the steps up to a time.
  void reach(double tau);
  /// Time up to which steps have been taken [s].
  double reached() const;

  /// Lets the current motion exceed the limits of grip and resistance by a relative 2^-30.
  void loosen();

  /// Promises that no time before tau will be requested.
  void forget_before(double tau);
  /// See numeric::Trajectory.
  void release_memory() { trajectory_.release_memory(); }

 private:
  void choose_unit(double speed, const scene::Material& ground, const Vector2d& position);
  numeric::Equations equations(numeric::EquationForm form, const scene::Material& ground,
                               const Vector2d& position) const;
  void detect_rest();
  void begin(const numeric::Equations& equations, const scene::Material& ground, const Vector2d& position,
             const NormalSpin& spin);
  void begin_dry(const Vector2d& w);
  void find_line(const Vector2d& velocity, const numeric::State& y, const Vector2d& w);
  numeric::State state(double tau, Vector2d* path_velocity = nullptr);
  numeric::State computed(double tau, Vector2d* path_velocity);
  void keep_on_line(numeric::State& y) const;
  void cover(double tau);
  void detect_stop();
  double deviation_of(int i, const numeric::State& y, const numeric::Instant& now, double rest, double rate,
                      const numeric::SpeedBound& bound) const;
  void stop_at(int i, double time);
  /// A vector whose direction matters, at the time of a state.
  struct Turning {
    Vector2d w;     ///< [m/s]
    Vector2d rate;  ///< of w, without dry friction against it [m/s^2]
    double width;   ///< time in which it turns, where it is shortest [s]
  };
  RapidChange rapid_change_in_step(std::size_t node, double from);
  template <class Function>
  RapidChange rapid_change_of(const Function& turning, std::size_t node, double from);
  numeric::State stopping(double tau) const;
  void find_loss_of_grip();
  void find_end_of_sticking(double horizon);
  void end_at(double time, MotionEnd reason);
  PointState point_state(const numeric::State& y, const numeric::Instant& now) const;
  double series_end() const { return onset_ ? onset_->end() : 0; }

  Dynamics dynamics_;
  numeric::Trajectory trajectory_;
  std::optional<numeric::Equations> equations_;
  std::optional<numeric::SlipOnset> onset_;               // of a w that starts from 0
  std::optional<numeric::FrictionLimit> friction_limit_;  // where grip can be lost
  std::optional<numeric::StickingMotion> sticking_;
  Vector2d start_ = Vector2d::Zero();
  double friction_ = never;  // mu; infinite where the ground always grips
  NormalSpin spin_;
  Vector2d planar_spin_ = Vector2d::Zero();  // free: omega_1, omega_2 at the beginning
  double unit_ = 1;                          // of lengths [m]
  double scale_ = never;                     // time to move by a radius from rest [s]
  Vector2d velocity_ = Vector2d::Zero();     // at the beginning, if known
  Vector2d acceleration_ = Vector2d::Zero();
  Vector2d line_ = Vector2d::Zero();  // Curve::line
  double line_size_ = 0;
  bool rests_ = false;        // the remaining motion is less than rounding
  bool is_stopping_ = false;  // w is so small that the remaining motion is known
  double stop_time_ = never;
  double fastest_ = 0;       // of the centre so far
  int stopping_vector_ = 0;  // of the vectors that dry friction uses up: the first, the second, or 2 both
  double end_ = never;
  MotionEnd end_reason_ = MotionEnd::grip_lost;
  std::size_t checked_nodes_ = 0;  // number of nodes whose steps, and the onset, are known to keep the grip
  bool onset_is_checked_ = false;
  double searched_until_ = 0;
};

}  // namespace hybrid_sphere
