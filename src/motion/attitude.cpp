#include "motion/attitude.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <string>

#include "hybrid_sphere/numerical_error.hpp"
#include "interrupt/interrupt.hpp"
#include "motion/spin_rules.hpp"
#include "sphere/unit_quaternion.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere {

void Attitude::begin(const Quaterniond& orientation, Motion& motion, const SpinProfile& profile) {
  start_ = orientation;
  profile_ = profile;
  round_known_ = false;
  round_start_ = 0;
  now_.clear();
  kept_.clear();
  constant_ =
      ConstantTwist(Vector2d::Zero(), orientation,
                    {Vector2d::Zero(), profile.constant ? motion.angular_velocity(0) : Vector3d::Zero()});
}

void Attitude::hold(const Quaterniond& orientation) {
  profile_ = {};
  profile_.constant = true;
  constant_ = ConstantTwist(Vector2d::Zero(), orientation, {});
  now_.clear();
  kept_.clear();
}

void Attitude::restart(Motion& motion) {
  now_.clear();
  now_.node = now_.next_node = start_;
  now_.rate = motion.angular_velocity(0).norm();
  now_.length = profile_.rule != SpinRule::series ? profile_.step
                : now_.rate > 0                   ? (profile_.linear ? 2 : 1) * usual_angle / now_.rate
                                                  : 1;
  now_.slow_length = never;
  advance(motion);
}

/// To the steps that begin before a time.
void Attitude::go_back(double tau, Motion& motion) {
  if (kept_.until == never || tau < kept_.from) {
    restart(motion);
  } else {
    now_ = kept_;
  }
}

void Attitude::take(double until, const Quaterniond& next_node, double error, double angle) {
  now_.until = until;
  now_.panel_until = profile_.rule == SpinRule::series ? std::min(until, profile_.period) : -never;
  now_.inverse_length = std::min(1 / (until - now_.from), DBL_MAX);
  now_.next_node = to_unit(next_node);
  if (!now_.next_node.coeffs().allFinite()) {
    throw NumericalError("the orientation cannot be integrated beyond " + text::shortest(now_.from) +
                         " s into the segment: it is not finite");
  }
  now_.error += error;
  now_.angle += angle;
}

/// A step that errs by a radian leads nowhere. Nor does one on the quaternion, where a rotation is an
/// oscillation with half its rate, beyond the limit of stability; for Euler's method, which has none, beyond
/// a right angle.
void Attitude::check_fixed_step(const Turn& turn) const {
  constexpr double right_angle = 1.5707963267948966;
  constexpr double stable = 2.828;
  constexpr double lost = 1;
  const double longest = profile_.rule == SpinRule::euler ? right_angle
                         : profile_.rule == SpinRule::rk4 ? stable
                                                          : never;
  if (0.5 * turn.angle <= longest && turn.error <= lost) return;
  throw NumericalError("the orientation cannot be integrated beyond " + text::shortest(now_.from) +
                       " s into the segment: the fixed step is too long");
}

/// Where the step that begins now ends at the latest.
double Attitude::border() const {
  return now_.from < profile_.kink ? std::min(profile_.kink, profile_.end) : profile_.end;
}

/// Of the time until the end of the motion, where that is singular for dry friction, what a step up to a time
/// leaves.
double Attitude::part_left(double until) const {
  const bool has_end = until < profile_.end && profile_.end < never;
  return has_end && !profile_.linear ? (profile_.end - until) / (profile_.end - now_.from) : 1;
}

/// Where a step of this length ends: not beyond the border, and never where it begins.
double Attitude::end_of_step(double length) const {
  const double until = std::max(now_.from + length, std::nextafter(now_.from, never));
  return now_.from < border() ? std::min(until, border()) : until;
}

// Finds the step that begins at now_.from.
void Attitude::advance(Motion& motion) {
  if (profile_.rule != SpinRule::series) {
    advance_by_rule(motion);
    return;
  }
  const double longest = longest_panel(motion);
  if (!advance_slowly(motion, longest)) advance_directly(motion, longest);
}

void Attitude::advance_by_rule(Motion& motion) {
  interruption_point(turns_of_a_step);
  ++now_.steps;
  const double until = end_of_step(now_.length);
  const Turn turn = turn_over(profile_.rule, motion, now_.from, until);
  check_fixed_step(turn);
  take(until, turn.rotation * now_.node, turn.error, turn.angle);
}

void Attitude::step_up_to(double tau, Motion& motion, std::uint64_t max_steps) {
  if (now_.until == never || tau < now_.from) go_back(tau, motion);
  while (tau >= now_.until && now_.until < profile_.end) {
    if (now_.steps >= max_steps) {
      throw NumericalError("the orientation takes more than " + std::to_string(max_steps) +
                           " steps from the start of the segment: the sphere spins too fast");
    }
    const Steps before = now_;  // the panel is the last to be replaced
    now_.node = now_.next_node;
    now_.from = now_.until;
    try {
      advance(motion);
    } catch (...) {
      static_cast<Steps&>(now_) = before;
      throw;
    }
  }
}

void Attitude::reach(double tau, Motion& motion) {
  if (profile_.constant || tau == 0) return;
  if (!(tau >= profile_.period)) {
    step_up_to(tau, motion, profile_.max_steps);
    return;
  }
  know_round(motion, profile_.max_steps);
  const double rest = std::fmod(tau, profile_.period);
  round_start_ = tau - rest;
  if (rest > 0) step_up_to(rest, motion, profile_.max_steps);
}

double Attitude::reached() const {
  if (profile_.constant) return never;
  if (now_.until == never) return 0;
  if (now_.until >= profile_.end) return never;
  return std::nextafter(round_start_ + std::min(now_.until, profile_.period), 0);
}

/// Whether the time is the node's but for rounding: it may have been told by two sums. What lies before the
/// node may be forgotten.
bool Attitude::just_before_node(double tau) const {
  constexpr double roundings = 16;
  return now_.until != never && tau < now_.from && now_.from - tau <= roundings * DBL_EPSILON * now_.from;
}

/// The orientation, step by step from the beginning.
Quaterniond Attitude::followed(double tau, Motion& motion, std::uint64_t max_steps) {
  if (tau == 0) return start_;
  if (just_before_node(tau)) return now_.node;
  step_up_to(tau, motion, max_steps);
  if (tau >= now_.until) return now_.next_node;
  if (tau == now_.from) return now_.node;
  if (profile_.rule == SpinRule::series) return within_panel(tau);
  return to_unit(turn_within_step(profile_.rule, motion, now_.from, tau) * now_.node);
}

/// The turn over one period, on the axes of the sphere.
void Attitude::know_round(Motion& motion, std::uint64_t max_steps) {
  if (round_known_) return;
  const Quaterniond round = start_.conjugate() * followed(profile_.period, motion, max_steps);
  const double sine = stable_norm(Vector3d(round.vec()));
  round_half_angle_ = std::atan2(sine, round.w());
  round_axis_ = sine > 0 ? Vector3d(round.vec() / sine) : Vector3d::Zero();
  round_error_ = now_.error;
  round_angle_ = now_.angle;
  round_known_ = true;
}

Quaterniond Attitude::found(double tau, Motion& motion) {
  constexpr std::uint64_t any = std::numeric_limits<std::uint64_t>::max();
  if (profile_.constant) return constant_.orientation(tau);
  if (!(tau >= profile_.period)) return followed(tau, motion, any);
  know_round(motion, any);
  const double rest = std::fmod(tau, profile_.period);  // exact, also after 1e16 rounds
  const double rounds = std::round((tau - rest) / profile_.period);
  const double angle = rounds * round_half_angle_;
  const Vector3d axis = std::sin(angle) * round_axis_;
  const Quaterniond past(std::cos(angle), axis.x(), axis.y(), axis.z());
  return followed(rest, motion, any) * past;
}

}  // namespace hybrid_sphere
