#include "motion/attitude.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <string>

#include "hybrid_sphere/numerical_error.hpp"
#include "interrupt/interrupt.hpp"
#include "motion/shorter_panels.hpp"
#include "motion/spin_rules.hpp"
#include "sphere/unit_quaternion.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere {

void Attitude::begin(const Quaterniond& orientation, Motion& motion, const SpinProfile& profile) {
  start_ = orientation;
  profile_ = profile;
  round_known_ = false;
  round_start_ = 0;
  now_ = kept_ = {};
  constant_ =
      ConstantTwist(Vector2d::Zero(), orientation,
                    {Vector2d::Zero(), profile.constant ? motion.angular_velocity(0) : Vector3d::Zero()});
}

void Attitude::hold(const Quaterniond& orientation) {
  profile_ = {};
  profile_.constant = true;
  constant_ = ConstantTwist(Vector2d::Zero(), orientation, {});
  now_ = kept_ = {};
}

namespace {

constexpr std::uint32_t turns_of_a_step = 4;
constexpr double usual_angle = 2;             // of a direct panel [rad]
constexpr double rounding = 4 * DBL_EPSILON;  // of the coefficients of a direct panel [rad]

/// The same of a slow panel, that of its phase included.
double phase_rounding(double angle) { return rounding + DBL_EPSILON * angle; }

// Longest step from a time on that shows a corner to the nodes. What is shorter than 2^-40 of the time until
// the corner turns nothing.
double near_corner(const SpinProfile& profile, double from) {
  const double width = std::max(profile.corner_width, 0x1p-40 * profile.corner);
  return from < profile.corner ? std::max(0.5 * (profile.corner - from), width)
                               : from - profile.corner + width;
}

}  // namespace

void Attitude::restart(Motion& motion) {
  now_ = {};
  now_.node = now_.next_node = start_;
  now_.rate = motion.angular_velocity(0).norm();
  now_.length = profile_.rule != SpinRule::series ? profile_.step
                : now_.rate > 0                   ? usual_angle / now_.rate
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

/// Where a step of this length ends: not beyond the border, and never where it begins.
double Attitude::end_of_step(double length) const {
  const double until = std::max(now_.from + length, std::nextafter(now_.from, never));
  return now_.from < border() ? std::min(until, border()) : until;
}

constexpr double least_slow_angle = RotationPanel::least_slow_angle;

/// The rounding of a slow panel is that of all its angle: this is not much more than what has been turned
/// before.
double Attitude::largest_slow_angle() const { return now_.angle + least_slow_angle; }

/// Length of the slow panel to try; 0 for none. Where the sphere turns little, direct ones cost less.
double Attitude::slow_length(double longest) const {
  if (now_.angle < least_slow_angle || now_.from < now_.slow_from || now_.rate == 0) return 0;
  const double length = std::min({now_.slow_length, longest, largest_slow_angle() / now_.rate});
  return now_.rate * length >= least_slow_angle ? length : 0;
}

/// Never far beyond what the motion has shown of itself so far. A rapid change shows itself to a panel that
/// ends half-way to it, or that is no longer than it lasts. No panel goes over an end, and towards it they
/// shorten: dry friction turns by a power of the time that is left.
double Attitude::longest_panel(Motion& motion) const {
  const double from = now_.from;
  const double shown = std::min(from + profile_.scale, near_corner(profile_, from));
  const double until = from + std::min(shown, std::max(now_.length, slow_length(shown)));
  const RapidChange change = motion.rapid_change(from, from < border() ? std::min(until, border()) : until);
  if (change.time == never) return shown;
  const double ahead = change.time - from;
  if (change.width > 0) {
    return std::min(shown, std::max(0.5 * ahead, std::max(change.width, 0x1p-40 * change.time)));
  }
  return std::min(shown, ahead > 0x1p-16 * change.time ? 0.75 * ahead : ahead);
}

namespace {

RotationPanel::Spin spin_on_nodes(Motion& motion, double from, double until) {
  RotationPanel::Spin omega;
  for (int i = 0; i < RotationPanel::size; ++i) {
    const double part = 0.5 * (1 + RotationPanel::node(i));
    omega.row(i) = motion.angular_velocity(from + part * (until - from)).transpose();
  }
  return omega;
}

RotationPanel::Fit fit_direct(Motion& motion, double from, double until, const Quaterniond& start,
                              RotationPanel& panel) {
  polynomials::Powers<3> powers;
  const double half = 0.5 * (until - from);
  const int terms = motion.expand_spin(from + half, half, powers);
  if (terms > 0) return panel.expand(powers, terms, until - from, start);
  return panel.fit_direct(spin_on_nodes(motion, from, until), until - from, start);
}

/// By what the length of a panel may be multiplied, or has to be, for the error that is allowed.
/// @param floor  errors below are those of rounding and tell nothing
/// @param most   there
double change_of_length(double error, double allowed, double floor, double most) {
  constexpr double order = RotationPanel::size;
  if (!std::isfinite(error)) return 0.1;
  const double by_error = error > 0 ? std::clamp(0.9 * std::pow(error / allowed, -1 / order), 0.1, 2.0) : 2;
  return error <= floor && error <= allowed ? std::max(most, by_error) : by_error;
}

}  // namespace

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

namespace {

constexpr double much_noise = 1e-9;  // of the angular velocity

}  // namespace

/// Tries slow panels; where the axis changes too fast, none for twice as long as the last time.
bool Attitude::advance_slowly(Motion& motion, double longest) {
  const double from = now_.from;
  double length = slow_length(longest);
  if (length == 0) return false;
  ShorterPanels shorter(0x1p-4);
  while (now_.rate * length >= least_slow_angle) {
    interruption_point(turns_of_a_step);
    ++now_.steps;
    const double until = end_of_step(length);
    const RotationPanel::Spin omega = spin_on_nodes(motion, from, until);
    RotationPanel panel;
    const RotationPanel::Fit fit = panel.fit_slow(omega, until - from, now_.node);
    const double floor = phase_rounding(fit.angle);
    const double allowed = allowed_error(fit.angle, until - from) + floor;
    const double next = change_of_length(fit.error, allowed, 0.5 * floor, 2) * (until - from);
    const bool fits = fit.angle >= least_slow_angle && fit.angle <= 2 * largest_slow_angle();
    const bool no_better = shorter.are_no_better(length, fit.error) && fit.error <= much_noise * fit.angle;
    if (fits && (fit.error <= allowed || no_better)) {
      now_.noise = no_better ? 2 * fit.error / (until - from) : 0.5 * now_.noise;
      now_.panel = panel;
      now_.rate = fit.rate;
      now_.slow_length = no_better ? shorter.best_length() : next;
      now_.slow_wait = 0;
      take(until, panel.at(1), fit.error > floor ? fit.error : 0, fit.angle);
      return true;
    }
    length = std::min(next, 0.7 * length);
  }
  now_.slow_wait = std::max(2 * now_.slow_wait, least_slow_angle / now_.rate);
  now_.slow_from = from + now_.slow_wait;
  now_.slow_length = never;
  return false;
}

/// What a panel may err by, beyond rounding [rad].
double Attitude::allowed_error(double angle, double length) const {
  return profile_.accuracy * angle + noise() * length;
}

namespace {

/// The axis changes while the sphere turns by radians between two neighbouring numbers of time.
NumericalError beyond_resolution(double from) {
  return NumericalError("the orientation cannot be integrated beyond " + text::shortest(from) +
                        " s into the segment: the sphere spins too fast for the resolution of time");
}

}  // namespace

/// What the angular velocity may err by anyway, also by the rounding of its phase [rad/s].
double Attitude::noise() const {
  const double of_phase = 2 * DBL_EPSILON * profile_.frequency * now_.from * now_.rate;
  return profile_.noise + now_.noise + of_phase;
}

/// Up to this, an error does not tell whether another length were better [rad].
double Attitude::untold_error(double length) const {
  return std::max({0.25 * rounding, now_.floor, now_.noise * length, 0.25 * noise() * length});
}

/// @param shown        whether shorter panels have not been better
/// @param is_constant  nor worse by the time
void Attitude::note_noise(double error, double length, bool shown, bool is_constant) {
  const double noise = 2 * error / length;
  if (shown && is_constant) {
    now_.floor = 2 * error;
  } else {
    now_.noise = shown ? noise : std::max(0.5 * now_.noise, std::min(now_.noise, noise));
  }
}

void Attitude::advance_directly(Motion& motion, double longest) {
  const double from = now_.from;
  double length = std::min(now_.length, longest);
  if (now_.rate > 0) length = std::min(length, 4 * usual_angle / now_.rate);
  ShorterPanels shorter(0x1p-6);
  for (;;) {
    interruption_point(turns_of_a_step);
    ++now_.steps;
    const double until = end_of_step(length);
    RotationPanel panel;
    const RotationPanel::Fit fit = fit_direct(motion, from, until, now_.node, panel);
    const double floor = std::max(rounding, now_.floor);
    const double allowed = allowed_error(fit.angle, until - from) + floor;
    const double excess = fit.error / allowed;
    const double most = std::clamp(1.5 * usual_angle / fit.angle, 1.1, 2.0);
    const double untold = fit.is_truncation ? 0 : untold_error(until - from);
    const double next = change_of_length(fit.error, allowed, untold, most) * (until - from);
    const bool finest = from + next <= from;
    const bool no_better = shorter.are_no_better(length, fit.error);
    if (finest && !(fit.error <= 1)) throw beyond_resolution(from);
    if (excess <= 1 || finest || no_better) {
      note_noise(fit.error, until - from, no_better, shorter.is_constant(fit.error));
      // A panel that was clipped says nothing against the length before it.
      if (!finest) {
        now_.length = no_better           ? shorter.best_length()
                      : until == border() ? std::max(now_.length, next)
                                          : next;
      }
      now_.panel = panel;
      now_.rate = fit.rate;
      take(until, panel.at(1), fit.error > floor ? fit.error : 0, fit.angle);
      return;
    }
    length = std::min(next, shorter.gains() ? length : 0.25 * length);
  }
}

void Attitude::step_up_to(double tau, Motion& motion, std::uint64_t max_steps) {
  if (now_.until == never || tau < now_.from) go_back(tau, motion);
  while (tau >= now_.until && now_.until < profile_.end) {
    if (now_.steps >= max_steps) {
      throw NumericalError("the orientation takes more than " + std::to_string(max_steps) +
                           " steps from the start of the segment: the sphere spins too fast");
    }
    const Progress before = now_;
    now_.node = now_.next_node;
    now_.from = now_.until;
    try {
      advance(motion);
    } catch (...) {
      now_ = before;
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
  const double sine = round.vec().stableNorm();
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
