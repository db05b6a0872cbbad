// The steps of the orientation by panels, and how long they may be.
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <string>

#include "hybrid_sphere/numerical_error.hpp"
#include "interrupt/interrupt.hpp"
#include "motion/attitude.hpp"
#include "motion/shorter_panels.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere {
namespace {

constexpr double rounding = 4 * DBL_EPSILON;  // of the coefficients of a direct panel [rad]
constexpr double much_noise = 1e-9;           // of the angular velocity

/// The same of a slow panel, that of its phase included.
double phase_rounding(double angle) { return rounding + DBL_EPSILON * angle; }

// Longest step from a time on that shows a corner to the nodes. What is shorter than 2^-40 of the time until
// the corner turns nothing.
double near_corner(const SpinProfile& profile, double from) {
  const double width = std::max(profile.corner_width, 0x1p-40 * profile.corner);
  return from < profile.corner ? std::max(0.5 * (profile.corner - from), width)
                               : from - profile.corner + width;
}

/// The axis changes while the sphere turns by radians between two neighbouring numbers of time.
NumericalError beyond_resolution(double from) {
  return NumericalError("the orientation cannot be integrated beyond " + text::shortest(from) +
                        " s into the segment: the sphere spins too fast for the resolution of time");
}

}  // namespace

/// By how much a slow panel turns the sphere at least [rad]: direct ones that do so cost as much.
double Attitude::least_slow_angle() const { return now_.is_expanded ? 120 : 60; }

/// The rounding of a slow panel is that of all its angle: this is not much more than what has been turned
/// before.
double Attitude::largest_slow_angle() const { return now_.angle + least_slow_angle(); }

/// Length of the slow panel to try; 0 for none. Where the sphere turns little, direct ones cost less.
double Attitude::slow_length(double longest) const {
  if (now_.angle < least_slow_angle() || now_.from < now_.slow_from || now_.rate == 0) return 0;
  const double length = std::min({now_.slow_length, longest, largest_slow_angle() / now_.rate});
  return now_.rate * length >= least_slow_angle() ? length : 0;
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
  static_assert(RotationPanel::size == 16);  // the order
  if (!std::isfinite(error)) return 0.1;
  const double root = std::sqrt(std::sqrt(std::sqrt(std::sqrt(error / allowed))));
  const double by_error = error > 0 ? std::clamp(0.9 / root, 0.1, 2.0) : 2;
  return error <= floor && error <= allowed ? std::max(most, by_error) : by_error;
}

}  // namespace

/// Tries slow panels; where the axis changes too fast, none for twice as long as the last time.
bool Attitude::advance_slowly(Motion& motion, double longest) {
  const double from = now_.from;
  double length = slow_length(longest);
  if (length == 0) return false;
  ShorterPanels shorter(0x1p-4);
  while (now_.rate * length >= least_slow_angle()) {
    interruption_point(turns_of_a_step);
    ++now_.steps;
    const double until = end_of_step(length);
    const RotationPanel::Spin omega = spin_on_nodes(motion, from, until);
    RotationPanel panel;
    const RotationPanel::Fit fit = panel.fit_slow(omega, until - from, now_.node);
    const double floor = phase_rounding(fit.angle);
    const double allowed = allowed_error(fit.angle, until - from) + floor;
    const double next = change_of_length(fit.error, allowed, 0.5 * floor, 2) * (until - from);
    const bool fits = fit.angle >= least_slow_angle() && fit.angle <= 2 * largest_slow_angle();
    const bool no_better = shorter.are_no_better(length, fit.error) && fit.error <= much_noise * fit.angle;
    if (fits && (fit.error <= allowed || no_better)) {
      now_.noise = no_better ? 2 * fit.error / (until - from) : 0.5 * now_.noise;
      now_.rate = fit.rate;
      now_.slow_length = no_better ? shorter.best_length() : next;
      now_.slow_wait = 0;
      take(until, panel.at(1), fit.error > floor ? fit.error : 0, fit.angle);
      now_.panel = panel;
      return true;
    }
    length = std::min(next, 0.7 * length);
  }
  now_.slow_wait = std::max(2 * now_.slow_wait, least_slow_angle() / now_.rate);
  now_.slow_from = from + now_.slow_wait;
  now_.slow_length = never;
  return false;
}

/// What a panel may err by, beyond rounding [rad].
double Attitude::allowed_error(double angle, double length) const {
  return profile_.accuracy * angle + noise() * length;
}

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
  const double longest_angle = (now_.is_expanded ? 8 : 4) * usual_angle;
  if (now_.rate > 0) length = std::min(length, longest_angle / now_.rate);
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
                                          : next * part_left(until);
      }
      now_.rate = fit.rate;
      now_.is_expanded = fit.is_truncation;
      take(until, panel.at(1), fit.error > floor ? fit.error : 0, fit.angle);
      now_.panel = panel;
      return;
    }
    length = std::min(next, shorter.gains() ? length : 0.25 * length);
  }
}

}  // namespace hybrid_sphere
