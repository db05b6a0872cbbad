#include "motion/attitude.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <string>

#include "hybrid_sphere/numerical_error.hpp"
#include "interrupt/interrupt.hpp"
#include "motion/spin_rules.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere {

void Attitude::begin(const Quaterniond& orientation, Motion& motion, const SpinProfile& profile) {
  start_ = orientation;
  profile_ = profile;
  steps_ = 0;
  error_ = 0;
  angle_ = 0;
  round_known_ = false;
  round_start_ = 0;
  until_ = never;
  kept_ = {};
  if (profile.constant) constant_ = motion.angular_velocity(0);
}

void Attitude::hold(const Quaterniond& orientation) {
  *this = {};
  start_ = orientation;
  profile_.constant = true;
}

namespace {

// Longest step from a time on that shows a corner to the nodes. What is shorter than 2^-40 of the time until
// the corner turns nothing.
double near_corner(const SpinProfile& profile, double from) {
  const double width = std::max(profile.corner_width, 0x1p-40 * profile.corner);
  return from < profile.corner ? std::max(0.5 * (profile.corner - from), width)
                               : from - profile.corner + width;
}

}  // namespace

void Attitude::restart(Motion& motion) {
  until_ = never;
  node_ = Quaterniond::Identity();
  const double rate = motion.angular_velocity(0).norm();
  length_ = rate > 0 ? 0.25 / rate : 1;
  if (profile_.rule != SpinRule::magnus) length_ = profile_.step;
  from_ = 0;
  steps_ = 0;
  error_ = 0;
  angle_ = 0;
  advance(motion);
}

/// To the steps that begin before a time.
void Attitude::go_back(double tau, Motion& motion) {
  if (kept_.until == never || tau < kept_.from) {
    restart(motion);
    return;
  }
  from_ = kept_.from;
  until_ = kept_.until;
  node_ = kept_.node;
  next_node_ = kept_.next_node;
  length_ = kept_.length;
  error_ = kept_.error;
  angle_ = kept_.angle;
  steps_ = kept_.steps;
}

void Attitude::take(double until, const Turn& turn) {
  until_ = until;
  next_node_ = (turn.rotation * node_).normalized();
  if (!next_node_.coeffs().allFinite()) {
    throw NumericalError("the orientation cannot be integrated beyond " + text::shortest(from_) +
                         " s into the segment: it is not finite");
  }
  error_ += turn.error;
  angle_ += turn.angle;
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
  throw NumericalError("the orientation cannot be integrated beyond " + text::shortest(from_) +
                       " s into the segment: the fixed step is too long");
}

// The turn shows itself to a step that ends half-way to it, or that is no longer than it lasts. No step goes
// over an end, and towards it they shorten: dry friction turns by a power of the time that is left.
void Attitude::shorten_before_turn(Motion& motion, double border) {
  const double until = from_ + length_;
  const RapidChange turn = motion.rapid_change(from_, from_ < border ? std::min(until, border) : until);
  if (turn.time == never) return;
  const double ahead = turn.time - from_;
  if (turn.width > 0) {
    length_ = std::min(length_, std::max(0.5 * ahead, std::max(turn.width, 0x1p-40 * turn.time)));
  } else {
    length_ = std::min(length_, ahead > 0x1p-16 * turn.time ? 0.75 * ahead : ahead);
  }
}

constexpr std::uint32_t turns_of_a_step = 4;

// Finds the step that begins at from_.
void Attitude::advance(Motion& motion) {
  const double border = from_ < profile_.kink ? std::min(profile_.kink, profile_.end) : profile_.end;
  // Never far beyond what the motion has shown of itself so far.
  if (profile_.rule == SpinRule::magnus) {
    length_ = std::min({length_, from_ + profile_.scale, near_corner(profile_, from_)});
  }
  if (profile_.rule == SpinRule::magnus) shorten_before_turn(motion, border);
  for (;;) {
    interruption_point(turns_of_a_step);
    ++steps_;
    const bool clipped = from_ < border && from_ + length_ >= border;
    const double until = clipped ? border : from_ + length_;
    const Turn turn = turn_over(profile_.rule, motion, from_, until, profile_.accuracy);
    if (profile_.rule != SpinRule::magnus) {
      check_fixed_step(turn);
      take(until, turn);
      return;
    }
    // 2^-60 is far below the rounding of a quaternion.
    const double part = turn.error / (profile_.accuracy * turn.angle + 0x1p-60);
    const double factor = part > 0 ? std::clamp(0.9 * std::pow(part, -0.125), 0.1, 2.0) : 2.0;
    const double next = factor * (until - from_);
    const bool finest = from_ + next <= from_;
    if (part <= 1 || finest) {
      // A step that was clipped says nothing against the length before it.
      if (!finest) length_ = clipped ? std::max(length_, next) : next;
      take(until, turn);
      return;
    }
    length_ = next;
  }
}

void Attitude::step_up_to(double tau, Motion& motion, std::uint64_t max_steps) {
  if (until_ == never || tau < from_) go_back(tau, motion);
  while (tau >= until_ && until_ < profile_.end) {
    if (steps_ >= max_steps) {
      throw NumericalError("the orientation takes more than " + std::to_string(max_steps) +
                           " steps from the start of the segment: the sphere spins too fast");
    }
    const double last = from_;
    const Quaterniond last_node = node_;
    const double length = length_;
    const std::uint64_t steps = steps_;
    node_ = next_node_;
    from_ = until_;
    try {
      advance(motion);
    } catch (...) {
      node_ = last_node;
      from_ = last;
      length_ = length;
      steps_ = steps;
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
  if (until_ == never) return 0;
  if (until_ >= profile_.end) return never;
  return std::nextafter(round_start_ + std::min(until_, profile_.period), 0);
}

/// Whether the time is the node's but for rounding: it may have been told by two sums. What lies before the
/// node may be forgotten.
bool Attitude::just_before_node(double tau) const {
  constexpr double roundings = 16;
  return until_ != never && tau < from_ && from_ - tau <= roundings * DBL_EPSILON * from_;
}

// Turn from 0 to tau.
Quaterniond Attitude::turn(double tau, Motion& motion, std::uint64_t max_steps) {
  if (tau == 0) return Quaterniond::Identity();
  if (just_before_node(tau)) return node_;
  step_up_to(tau, motion, max_steps);
  if (tau >= until_) return next_node_;
  if (tau == from_) return node_;
  return (turn_within_step(profile_.rule, motion, from_, tau, profile_.accuracy) * node_).normalized();
}

/// The turn over one period.
void Attitude::know_round(Motion& motion, std::uint64_t max_steps) {
  if (round_known_) return;
  const Quaterniond round = turn(profile_.period, motion, max_steps);
  const double sine = round.vec().stableNorm();
  round_half_angle_ = std::atan2(sine, round.w());
  round_axis_ = sine > 0 ? Vector3d(round.vec() / sine) : Vector3d::Zero();
  round_known_ = true;
}

Quaterniond Attitude::at(double tau, Motion& motion) {
  constexpr std::uint64_t any = std::numeric_limits<std::uint64_t>::max();
  if (profile_.constant) return exponential(tau * constant_) * start_;
  if (!(tau >= profile_.period)) return turn(tau, motion, any) * start_;
  know_round(motion, any);
  const double rest = std::fmod(tau, profile_.period);  // exact, also after 1e16 rounds
  const double rounds = std::round((tau - rest) / profile_.period);
  const double angle = rounds * round_half_angle_;
  const Vector3d axis = std::sin(angle) * round_axis_;
  const Quaterniond past(std::cos(angle), axis.x(), axis.y(), axis.z());
  return turn(rest, motion, any) * past * start_;
}

}  // namespace hybrid_sphere
