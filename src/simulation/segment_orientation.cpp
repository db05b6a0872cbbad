// The orientation along a segment, and how far it and the motion are known.
#include <algorithm>
#include <cfloat>
#include <cmath>

#include "hybrid_sphere/numerical_error.hpp"

#include "simulation/segment.hpp"

namespace hybrid_sphere {
namespace {

SpinRule spin_rule(scene::Solver::Method method) {
  using Method = scene::Solver::Method;
  switch (method) {
    case Method::euler: return SpinRule::euler;
    case Method::rk4: return SpinRule::rk4;
    case Method::lie_midpoint: return SpinRule::midpoint;
    case Method::rkmk4: return SpinRule::rkmk4;
    default: return SpinRule::series;
  }
}

/// With fixed steps the orientation may fail even if the path is known for all times.
bool takes_fixed_steps(scene::Solver::Method method) { return spin_rule(method) != SpinRule::series; }

}  // namespace

double spin_accuracy(double accuracy, bool closed_form) {
  constexpr double to_rounding = scene::Solver().accuracy;
  const double finest = SpinProfile().accuracy;
  return closed_form && accuracy <= to_rounding ? finest : std::max(finest, 0.02 * accuracy);
}

SpinProfile Segment::spin_profile(const Start& start) const {
  SpinProfile profile = motion_->spin_profile();
  if (!profile.linear) profile.scale = time_scale_;
  profile.rule = spin_rule(solver_.method);
  profile.step = solver_.step;
  profile.accuracy = spin_accuracy(solver_.accuracy, !motion_->is_integrated());
  if (mode_ == ContactMode::free) return profile;
  // Of a difference of velocities, to rounding or to a part of the accuracy.
  const double speed = first_speed() + ground_velocity(material_, start.position).norm();
  const double relative = motion_->is_integrated() ? 0.1 * solver_.accuracy : DBL_EPSILON;
  profile.noise = relative * speed / dynamics_.radius;
  return profile;
}

void Segment::begin_attitude(const Start& start, const SpinProfile& profile) {
  if (!follows_orientation_) {
    attitude_.hold(start.orientation);
    lazy_until_ = never;
    return;
  }
  attitude_.begin(start.orientation, *outputs_, profile);
  lazy_until_ = find_lazy_time(start, profile);
}

/// Until when the orientation of an integrated motion is computed only on request, which then visits all
/// steps of the motion.
double Segment::lazy_until() const {
  constexpr std::uint64_t few = 1 << 12;
  return numeric_->steps(0, lazy_until_) > few ? 0 : lazy_until_;
}

/// Until when a motion certainly turns the sphere so little, and changes its spin so rarely, that its
/// orientation at any time can be computed within milliseconds: at most 1e4 rad, from the initial speeds and
/// the accelerations that the forces can give, and at most 1e3 times the time in which they change it.
double Segment::find_lazy_time(const Start& start, const SpinProfile& profile) {
  constexpr double angle = 1e4;
  constexpr double changes = 1e3;
  if (profile.constant) return never;
  if (profile.rule != SpinRule::series) return 0;  // steps of fixed length may fail
  if (motion_->last_time() < never) return 0;
  if (profile.period < max_time) {
    const double round = turned_in_a_round(profile.period);
    return round <= angle ? never : profile.period * (angle / round);
  }
  const double speed = start.twist.velocity.norm() + dynamics_.radius * start.twist.angular_velocity.norm() +
                       ground_velocity(material_, start.position).norm() +
                       std::sqrt(dynamics_.spring_rate) * (start.position - dynamics_.spring_center).norm();
  const double pull = pulls() + dynamics_.radius * std::abs(dynamics_.normal_spin);
  const double way = angle * dynamics_.radius;  // = speed tau + pull tau^2
  const double lazy =
      std::min(2 * way / (speed + std::sqrt(speed * speed + 4 * pull * way)), changes * time_scale_);
  // Farther out on a turntable the sphere is faster: in this time by a factor of at most e.
  const double turntable = std::abs(material_.turntable_rate);
  return turntable > 0 ? std::min(lazy / 3, 1 / turntable) : lazy;
}

/// Bound on the angle that a motion turns in a period [rad]: omega^2 is a constant plus a sine of this
/// period, so that two values half a period apart give its mean.
double Segment::turned_in_a_round(double period) {
  const double mean_square = 0.5 * (motion_->angular_velocity(0).squaredNorm() +
                                    motion_->angular_velocity(0.5 * period).squaredNorm());
  return period * std::sqrt(mean_square);
}

void Segment::forget_before(double tau) {
  if (numeric_) numeric_->release_memory();
  if (!integrates()) return;
  is_whole_ = false;
  attitude_.at(tau, *outputs_);
  attitude_.forget_before_now();
  // A node of the orientation may lie one rounding later.
  numeric_->forget_before(std::min(tau, attitude_.needs_from()));
}

void Segment::reach(double tau) {
  if (is_uniform_) return;
  if (tau > motion_->last_time()) {
    throw NumericalError("the motion diverges: its speed exceeds 1e100 m/s");
  }
  if (!integrates()) {
    if (tau > lazy_until_) attitude_.reach(tau, *outputs_);
    return;
  }
  try {
    numeric_->reach(tau);
  } catch (const NumericalError&) {
    follow_to_failure();
    throw;
  }
  const bool is_lazy = numeric_->reached() == never && tau <= lazy_until();  // it has come to rest
  if (!is_lazy || takes_fixed_steps(solver_.method)) attitude_.reach(tau, *outputs_);
}

/// The last time at which the state is known must not depend on the times requested before.
void Segment::follow_to_failure() {
  try {
    attitude_.reach(numeric_->reached(), *outputs_);
  } catch (const NumericalError&) {
    // Its next step would need the motion beyond its failure: reached() tells how far it came.
  }
}

double Segment::reached() const {
  if (is_uniform_) return never;
  if (!integrates()) {
    return std::min(motion_->last_time(), std::max(lazy_until_, attitude_.reached()));
  }
  const double reached = numeric_->reached();
  if (reached < never || takes_fixed_steps(solver_.method)) return std::min(reached, attitude_.reached());
  return std::max(lazy_until(), attitude_.reached());
}

}  // namespace hybrid_sphere
