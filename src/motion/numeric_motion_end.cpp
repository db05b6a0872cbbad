// How a motion that is integrated ends: what friction uses up, grip that is lost, rest.
#include <algorithm>
#include <cfloat>
#include <cmath>

#include "interrupt/interrupt.hpp"
#include "motion/numeric_motion.hpp"

namespace hybrid_sphere {

using numeric::EquationForm;
using numeric::Instant;
using numeric::State;

void NumericMotion::stop_at(int i, double time) {
  is_stopping_ = true;
  stopping_vector_ = i;
  stop_time_ = time;
}

// Of vector i, over the rest of its time: how far the drive may change, relative to what uses it up. e turns
// towards B, by at most the whole angle between them, B changes with the motion, and with the direction of
// the other vector.
double NumericMotion::deviation_of(int i, const State& y, const Instant& now, double rest, double rate,
                                   const numeric::SpeedBound& bound) const {
  constexpr double all = 0x1p+60;
  const numeric::DryVector dry = equations_->dry_vector(i, y, now);
  const double b = dry.drive.norm();
  const double along = dry.drive.dot(dry.e);
  // The angle matters by b (1 - cos): or, where abs(B) > A and w turns round, altogether.
  const double turn = b < dry.decay ? (b - along) / (dry.decay - b) : all;
  const numeric::ForcingBound forcing(*equations_, bound);
  const double drift =
      (forcing.force_rate + forcing.spin_rate + std::abs(equations_->turntable_rate()) * bound.acceleration) *
      rest / rate;
  if (dry.coupled == 0) return std::min(turn, 1.0) + drift;
  const numeric::DryVector other = equations_->dry_vector(1 - i, y, now);
  const double pull = other.drive.norm();
  const double left = other.w.norm() - (pull + other.decay) * rest;
  if (!(left > 0)) return all;
  return std::min(turn, 1.0) + drift + dry.coupled * pull / left * rest / rate;
}

// Near w = 0 the remaining time is abs(w)/(A - B.e), but for the change of B.e meanwhile. Once that is below
// rounding, the motion is taken to its end on a straight line.
void NumericMotion::detect_stop() {
  const double small = std::max(0x1p-54, 0.01 * trajectory_.tolerance());
  const State& y = trajectory_.last();
  const Instant now = equations_->instant(y);
  double rest = never;
  double rate = 0;
  int stopping = 0;
  const bool alone = equations_->dry_vectors() == 1;
  fastest_ = std::max(fastest_, now.velocity.norm());
  // The velocity may be what slip and ground leave of each other.
  const double ground = equations_->ground(numeric::displacement(y)).norm();
  const double rounding = 4 * DBL_EPSILON * (numeric::pair(y, 0).norm() + ground);
  for (int i = 0; i < equations_->dry_vectors(); ++i) {
    const numeric::DryVector dry = equations_->dry_vector(i, y, now);
    const double slows = dry.decay - dry.drive.dot(dry.e);
    // One whose rest is without end, because what drives it is just as much as friction can hold.
    const bool balanced = slows <= 0x1p-20 * dry.decay;
    const bool held = (!alone || balanced) && dry.drive.norm() <= (1 + 16 * DBL_EPSILON) * dry.decay;
    // From rest, what rounding of the forces that balance gives in the time of a way of a radius is none.
    const double unseen = scale_ < never ? 8 * DBL_EPSILON * dry.decay * scale_ : 0;
    const double least = balanced ? std::max({trajectory_.negligible(fastest_), alone ? 0 : rounding, unseen})
                                  : 0x1p-54 * small * now.velocity.norm();
    if (held && dry.w.norm() <= least) {
      stop_at(i, numeric::time_of(y));
      return;
    }
    if (dry.decay == 0 || !(slows > 0) || !(dry.w.norm() / slows < rest)) continue;
    rest = dry.w.norm() / slows;
    rate = slows;
    stopping = i;
  }
  if (rest == never) return;
  const double size = equations_->dry_vector(stopping, y, now).w.norm();
  const double duration = std::max(numeric::time_of(y), rest);
  const double speed = now.velocity.norm() + size + rate * duration;
  const numeric::SpeedBound bound(*equations_, y, rest);
  const double change = deviation_of(stopping, y, now, rest, rate, bound);
  const double least = 0x1p-54 * small * speed;
  const bool both = !alone && equations_->dry_vector(1 - stopping, y, now).w.norm() <= least;
  if (rest * change > small * duration || bound.acceleration * rest * rest > small * speed * duration) {
    if (!(size <= least) || !(alone || both)) return;
  }
  stop_at(both ? 2 : stopping, numeric::time_of(y) + rest);
}

// Where all forces but drag have a potential, sqrt(v^2 + abs(drive)^2/gamma) does not grow. Once it is less
// than the rounding of the way that has been made, the sphere is at rest as well as can be told; so it is
// where no force is left and the speed is too small for any time to tell.
void NumericMotion::detect_rest() {
  constexpr double small = 0x1p-40;  // of the way
  constexpr double nothing = numeric::least_speed;
  const State& y = trajectory_.last();
  const Vector2d d = numeric::displacement(y);
  const numeric::Drive drive = numeric::drive_of(*equations_, d);
  if (!drive.conserves) return;
  const double speed = equations_->instant(y).velocity.norm();
  if (drive.stiffness > 0) {
    const double frequency = std::sqrt(drive.stiffness);
    const double amplitude = std::hypot(speed, drive.drive.norm() / frequency) / frequency;
    rests_ = amplitude <= std::max(nothing / frequency, small * d.norm());
  } else {
    rests_ = drive.drive.isZero(0) && speed <= nothing;
  }
}

// The last bit of a motion against dry friction: w dies linearly.
State NumericMotion::stopping(double tau) const {
  State y = trajectory_.last();
  const double rest = stop_time_ - numeric::time_of(y);
  const double passed = std::min(tau - numeric::time_of(y), rest);
  const State rate = equations_->derivative(y);
  const double pace = equations_->pace(y);
  const double left = tau >= stop_time_ ? 0 : rest > 0 ? std::max(0.0, (rest - passed) / rest) : 0;
  for (const int i : {2, 4}) {
    if (pace > 0) numeric::set_pair(y, i, numeric::pair(y, i) + numeric::pair(rate, i) / pace * passed);
  }
  if (stopping_vector_ == 1 && pace > 0)
    numeric::set_pair(y, 0, numeric::pair(y, 0) + numeric::pair(rate, 0) / pace * passed);
  if (stopping_vector_ != 1) numeric::set_pair(y, 0, left * numeric::pair(y, 0));
  if (stopping_vector_ != 0) numeric::set_pair(y, 4, left * numeric::pair(trajectory_.last(), 4));
  y[6] = std::min(tau, stop_time_);
  return y;
}

void NumericMotion::end_at(double time, MotionEnd reason) {
  if (!(time < end_)) return;
  end_ = time;
  end_reason_ = reason;
}

// Looks at whole steps, so that the answer does not depend on the horizons that are asked for.
void NumericMotion::find_loss_of_grip() {
  const MotionEnd loss =
      equations_->form() == EquationForm::skidding ? MotionEnd::breaks_loose : MotionEnd::grip_lost;
  if (onset_ && !onset_is_checked_ && onset_->end() > 0) {
    const auto margin = [this](double tau) { return friction_limit_->along_onset(*onset_, tau); };
    const double curvature = friction_limit_->curvature(*onset_);
    const auto bound = [curvature](double, double) { return curvature; };
    end_at(numeric::first_loss(margin, bound, onset_->end()), loss);
    onset_is_checked_ = true;
  }
  for (; end_ == never; ++checked_nodes_) {
    interruption_point();
    const std::size_t i = std::max(checked_nodes_, trajectory_.forgotten()) - trajectory_.forgotten();
    if (i + 1 >= trajectory_.size()) return;
    const numeric::Node& node = trajectory_.node(i);
    const double begin = numeric::time_of(node.y);
    const State& far = trajectory_.node(i + 1).y;
    const double curvature = friction_limit_->curvature(node.y, node.step, numeric::time_of(far) - begin);
    const geometry::Jet near_jet = friction_limit_->along_trajectory(node.y);
    const geometry::Jet far_jet = friction_limit_->along_trajectory(far);
    const double least = std::min(near_jet.value - near_jet.noise, far_jet.value - far_jet.noise);
    if (least > 0.125 * curvature * node.step * node.step) continue;
    const auto margin = [&](double x) { return friction_limit_->along_trajectory(trajectory_.after(i, x)); };
    // The bound for a whole step may be larger by many powers of ten than that for a part of it.
    const auto bound = [&](double low, double high) {
      if (high - low == node.step) return curvature;
      const State from = trajectory_.after(i, low);
      const double duration = numeric::time_of(trajectory_.after(i, high)) - numeric::time_of(from);
      return std::min(curvature, friction_limit_->curvature(from, high - low, std::max(0.0, duration)));
    };
    const double x = numeric::first_loss(margin, bound, node.step);
    if (x < never) end_at(numeric::time_of(trajectory_.after(i, x)), loss);
  }
}

// In pieces that do not depend on the horizons that are asked for.
void NumericMotion::find_end_of_sticking(double horizon) {
  while (end_ == never && searched_until_ <= horizon && searched_until_ < sticking_->repeats()) {
    const double until = sticking_->next_piece(searched_until_);
    const double breaking = sticking_->first_breaking(searched_until_, until);
    const double slipping =
        friction_limit_ ? sticking_->first_slipping(friction_, searched_until_, until) : never;
    end_at(breaking, MotionEnd::breaks_loose);
    end_at(slipping, MotionEnd::grip_lost);
    searched_until_ = until;
  }
}

double NumericMotion::end_before(double horizon) {
  if (sticking_) {
    find_end_of_sticking(horizon);
  } else if (end_ == never && (equations_->is_dry() || friction_limit_)) {
    cover(horizon);
    if (friction_limit_) find_loss_of_grip();
    const bool slips = equations_->slides() && stopping_vector_ != 1;
    if (is_stopping_ && equations_->is_dry())
      end_at(stop_time_, slips ? MotionEnd::slip_used_up : MotionEnd::roll_used_up);
  }
  return end_ <= horizon ? end_ : never;
}

}  // namespace hybrid_sphere
