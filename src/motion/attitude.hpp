#pragma once

#include <cstdint>

#include "hybrid_sphere/numerical_error.hpp"
#include "motion/motion.hpp"

namespace hybrid_sphere {

struct Turn;

/// Orientation along a motion: q' = (0, omega) q / 2. Normally uses the Magnus method of sixth order on the
/// three Gauss points of a step, applied once over the step and once over its two halves and extrapolated
/// from both to eighth order, with steps as long as profile.accuracy allows; for accuracies of 5e-11 and
/// looser, the difference of the two is taken as the error, and between two nodes a single step without
/// halves is used. Alternatively uses a fixed-step rule. The steps depend on the motion alone and not on the
/// times at which the orientation is requested, so it is the same to the last bit however often it is
/// requested. The motion is evaluated up to one step beyond the time asked for, but not beyond profile.end.
/// Source: docs/theory.md 6.
class Attitude {
 public:
  /// @param orientation  q_0, body to world, unit, at tau = 0
  void begin(const Quaterniond& orientation, Motion& motion, const SpinProfile& profile = {});

  /// From now on q(tau) = q_0, whatever the motion does.
  void hold(const Quaterniond& orientation);

  /// q(tau), unit. Ascending times are cheapest.
  /// @param motion  the same as in begin
  /// @param tau     >= 0 [s]
  Quaterniond at(double tau, Motion& motion);

  /// Takes the steps that at(tau) needs. An exception of the motion changes nothing; after an interruption
  /// the next call resumes.
  /// @throws NumericalError  if that takes more than profile.max_steps; reached() says how far it got
  void reach(double tau, Motion& motion);
  /// Up to this time, at() evaluates the motion at no time later than the requested one [s].
  double reached() const;

  /// The motion is not needed before this time, as long as no time before the last one is requested [s].
  double needs_from() const { return profile_.constant ? never : until_ == never ? 0 : from_; }
  /// From now on the motion is not evaluated before needs_from(), even if a time earlier than the last one is
  /// requested: the steps restart from here.
  void forget_before_now() {
    if (!profile_.constant && until_ != never) {
      kept_ = {from_, until_, node_, next_node_, length_, error_, angle_, steps_};
    }
  }

  /// Estimated error of the steps since begin, and the angle turned in them [rad]. For a periodic motion,
  /// those of one period: their quotient is that of the whole motion.
  double error() const { return error_; }
  double angle() const { return angle_; }

  /// Number of steps tried since begin, or since a time earlier than a previous one was last requested.
  std::uint64_t steps() const { return steps_; }

 private:
  /// The steps so far.
  struct Progress {
    double from = 0;
    double until = never;
    Quaterniond node = Quaterniond::Identity();
    Quaterniond next_node = Quaterniond::Identity();
    double length = 0;
    double error = 0;
    double angle = 0;
    std::uint64_t steps = 0;
  };

  void restart(Motion& motion);
  void go_back(double tau, Motion& motion);
  void advance(Motion& motion);
  void check_fixed_step(const Turn& turn) const;
  void shorten_before_turn(Motion& motion, double border);
  void step_up_to(double tau, Motion& motion, std::uint64_t max_steps);
  void take(double until, const Turn& turn);
  bool just_before_node(double tau) const;
  void know_round(Motion& motion, std::uint64_t max_steps);
  Quaterniond turn(double tau, Motion& motion, std::uint64_t max_steps);

  Quaterniond start_ = Quaterniond::Identity();
  SpinProfile profile_;
  Vector3d constant_ = Vector3d::Zero();
  // Two nodes, and the turns from tau = 0 to them.
  double from_ = 0;
  double until_ = never;
  Quaterniond node_ = Quaterniond::Identity();
  Quaterniond next_node_ = Quaterniond::Identity();
  double length_ = 0;  // of the next step to try
  double error_ = 0;
  double angle_ = 0;
  std::uint64_t steps_ = 0;
  Progress kept_;  // where the steps restart if the earlier motion has been forgotten
  // Turn over one period, as half its angle and its axis.
  bool round_known_ = false;
  double round_start_ = 0;  // of the round in which reach() was last
  double round_half_angle_ = 0;
  Vector3d round_axis_ = Vector3d::Zero();
};

}  // namespace hybrid_sphere
