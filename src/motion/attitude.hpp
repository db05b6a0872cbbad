#pragma once

#include <cstdint>

#include "hybrid_sphere/numerical_error.hpp"
#include "motion/constant_twist.hpp"
#include "motion/motion.hpp"
#include "motion/rotation_panel.hpp"

namespace hybrid_sphere {

struct Turn;

/// Orientation along a motion: q' = (0, omega) q / 2. Normally follows panels (RotationPanel) as long as
/// profile.accuracy allows: slow ones, which may turn the sphere any number of times, where its axis changes
/// little, otherwise direct ones of a few radians. Alternatively uses a fixed-step rule. The panels depend on
/// the motion alone and not on the times at which the orientation is requested, so it is the same to the last
/// bit however often it is requested. The motion is evaluated up to one panel beyond the time asked for, but
/// not beyond profile.end. Source: docs/theory.md 6.
class Attitude {
 public:
  /// @param orientation  q_0, body to world, unit, at tau = 0
  void begin(const Quaterniond& orientation, Motion& motion, const SpinProfile& profile = {});

  /// From now on q(tau) = q_0, whatever the motion does.
  void hold(const Quaterniond& orientation);

  /// q(tau), unit. Ascending times are cheapest.
  /// @param motion  the same as in begin
  /// @param tau     >= 0 [s]
  Quaterniond at(double tau, Motion& motion) {
    const bool is_inside = tau > now_.from && tau < now_.panel_until;
    return is_inside ? within_panel(tau) : found(tau, motion);
  }

  /// Takes the steps that at(tau) needs. An exception of the motion changes nothing; after an interruption
  /// the next call resumes.
  /// @throws NumericalError  if that takes more than profile.max_steps; reached() says how far it got
  void reach(double tau, Motion& motion);
  /// Up to this time, at() evaluates the motion at no time later than the requested one [s].
  double reached() const;

  /// The motion is not needed before this time, as long as no time before the last one is requested [s].
  double needs_from() const { return profile_.constant ? never : now_.until == never ? 0 : now_.from; }
  /// From now on the motion is not evaluated before needs_from(), even if a time earlier than the last one is
  /// requested: the steps restart from here.
  void forget_before_now() {
    if (!profile_.constant && now_.until != never) kept_ = now_;
  }

  /// Estimated error of the steps since begin, and the angle turned in them [rad]. For a periodic motion,
  /// those of one period: their quotient is that of the whole motion.
  double error() const { return round_known_ ? round_error_ : now_.error; }
  double angle() const { return round_known_ ? round_angle_ : now_.angle; }

  /// Number of steps tried since begin, or since a time earlier than a previous one was last requested.
  std::uint64_t steps() const { return now_.steps; }

 private:
  /// The steps so far: the last one, from one node to the next, and what the next one depends on.
  struct Steps {
    double from = 0;
    double until = never;
    double panel_until = -never;  ///< before it the panel has the orientation, with no round before it [s]
    double inverse_length = 0;    ///< [1/s]
    Quaterniond node = Quaterniond::Identity();  ///< orientation there
    Quaterniond next_node = Quaterniond::Identity();
    double rate = 0;           ///< abs(omega), lately [rad/s]
    double length = 0;         ///< of the next step to try [s]
    bool is_expanded = false;  ///< whether the last direct panel was from Taylor polynomials
    double slow_length = 0;    ///< that of a slow panel
    double slow_from = 0;      ///< none is tried before this time [s]
    double slow_wait = 0;      ///< how long none is tried if the next one fails [s]
    double noise = 0;  ///< of omega, beyond that of the profile, as far as a panel has shown it [rad/s]
    double floor = 0;  ///< an error that no panel comes below, if one has shown it [rad]
    double error = 0;
    double angle = 0;
    std::uint64_t steps = 0;
  };
  /// The same with the last step's panel.
  struct Progress : Steps {
    RotationPanel panel;
    void clear() { static_cast<Steps&>(*this) = Steps(); }
  };

  static constexpr std::uint32_t turns_of_a_step = 4;
  static constexpr double usual_angle = 2;  // of a direct panel [rad]

  void restart(Motion& motion);
  void go_back(double tau, Motion& motion);
  void advance(Motion& motion);
  bool advance_slowly(Motion& motion, double longest);
  void advance_directly(Motion& motion, double longest);
  void advance_by_rule(Motion& motion);
  void check_fixed_step(const Turn& turn) const;
  double longest_panel(Motion& motion) const;
  double allowed_error(double angle, double length) const;
  double noise() const;
  double untold_error(double length) const;
  void note_noise(double error, double length, bool shown, bool is_constant);
  double least_slow_angle() const;
  double largest_slow_angle() const;
  double slow_length(double longest) const;
  double border() const;
  double part_left(double until) const;
  double end_of_step(double length) const;
  void take(double until, const Quaterniond& next_node, double error, double angle);
  void step_up_to(double tau, Motion& motion, std::uint64_t max_steps);
  bool just_before_node(double tau) const;
  Quaterniond within_panel(double tau) const {
    return now_.panel.at(2 * ((tau - now_.from) * now_.inverse_length) - 1);
  }
  Quaterniond found(double tau, Motion& motion);
  void know_round(Motion& motion, std::uint64_t max_steps);
  Quaterniond followed(double tau, Motion& motion, std::uint64_t max_steps);

  Quaterniond start_ = Quaterniond::Identity();
  SpinProfile profile_;
  ConstantTwist constant_;
  Progress now_;
  Progress kept_;  // where the steps restart if the earlier motion has been forgotten
  // Turn over one period, as half its angle and its axis on those of the sphere.
  bool round_known_ = false;
  double round_error_ = 0;
  double round_angle_ = 0;
  double round_start_ = 0;  // of the round in which reach() was last
  double round_half_angle_ = 0;
  Vector3d round_axis_ = Vector3d::Zero();
};

}  // namespace hybrid_sphere
