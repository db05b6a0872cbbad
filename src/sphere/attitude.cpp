#include "hybrid_sphere/sphere/attitude.hpp"

#include <algorithm>
#include <cmath>

namespace hybrid_sphere {
namespace {

Quaterniond exponential(const Vector3d& rotation) {
  const double angle = rotation.stableNorm();
  if (angle == 0) return Quaterniond::Identity();
  const double sine = std::sin(0.5 * angle) / angle;
  return {std::cos(0.5 * angle), sine * rotation.x(), sine * rotation.y(), sine * rotation.z()};
}

struct Magnus {
  Vector3d rotation;  // Theta
  double angle;       // an estimate of the angle turned
};

// Sixth order; Gauss points t + h (1/2 -+ sqrt(15)/10).
Magnus magnus(Motion& motion, double from, double h) {
  constexpr double offset = 0.3872983346207417;  // sqrt(15)/10
  constexpr double slope = 1.2909944487358056;   // sqrt(15)/3
  const double middle = from + 0.5 * h;
  const Vector3d first = motion.angular_velocity(middle - offset * h);
  const Vector3d second = motion.angular_velocity(middle);
  const Vector3d third = motion.angular_velocity(middle + offset * h);
  const Vector3d a1 = h * second;
  const Vector3d a2 = (slope * h) * (third - first);
  const Vector3d a3 = (10.0 / 3 * h) * ((third - second) - (second - first));
  const Vector3d c1 = a1.cross(a2);
  const Vector3d c2 = (-1.0 / 60) * a1.cross(2 * a3 + c1);
  return {a1 + a3 / 12 + (1.0 / 240) * (c1 - 20 * a1 - a3).cross(a2 + c2),
          h / 3 * (first.norm() + second.norm() + third.norm())};
}

struct Turn {
  Quaterniond rotation;
  double angle;
  double error;  // an estimate, in units of what is allowed
};

// One step and two half ones. The errors of both are odd powers of the length from the seventh on, so that
// a 63rd of their difference is the error of the half ones up to the ninth.
Turn turn_over(Motion& motion, double from, double until, double accuracy) {
  const double middle = from + 0.5 * (until - from);
  const Magnus whole = magnus(motion, from, until - from);
  const Magnus first = magnus(motion, from, middle - from);
  const Magnus second = magnus(motion, middle, until - middle);
  const Quaterniond halves = exponential(second.rotation) * exponential(first.rotation);
  const Vector3d difference = 2 * (halves * exponential(-whole.rotation)).vec();
  const double size = difference.norm();
  const double angle = first.angle + second.angle;
  // The term of the ninth power over that of the seventh: about angle^2/42 where commutators rule, else by
  // their powers of the length.
  const double ratio = angle > 0 ? angle * angle / 42 + 8 * std::cbrt(size / angle) : 1;
  const double error = size * std::min(1.0, ratio) / 63;
  // 2^-60 is far below the rounding of a quaternion.
  return {exponential(difference / 63) * halves, angle, error / (accuracy * angle + 0x1p-60)};
}

}  // namespace

void Attitude::begin(const Quaterniond& orientation, Motion& motion, const SpinCourse& course) {
  start_ = orientation;
  course_ = course;
  steps_ = 0;
  round_known_ = false;
  until_ = never;
  if (course.constant) constant_ = motion.angular_velocity(0);
}

void Attitude::restart(Motion& motion) {
  node_ = Quaterniond::Identity();
  const double rate = motion.angular_velocity(0).norm();
  length_ = rate > 0 ? 0.25 / rate : 1;
  from_ = 0;
  advance(motion);
}

// Finds the step that begins at from_.
void Attitude::advance(Motion& motion) {
  const double border = from_ < course_.kink ? std::min(course_.kink, course_.end) : course_.end;
  // Never far beyond what the motion has shown of itself so far.
  length_ = std::min(length_, from_ + course_.scale);
  for (;;) {
    ++steps_;
    const bool clipped = from_ < border && from_ + length_ >= border;
    const double until = clipped ? border : from_ + length_;
    const Turn turn = turn_over(motion, from_, until, course_.accuracy);
    const double factor = turn.error > 0 ? std::clamp(0.9 * std::pow(turn.error, -0.125), 0.1, 2.0) : 2.0;
    const double next = factor * (until - from_);
    const bool finest = from_ + next <= from_;
    if (turn.error <= 1 || finest) {
      // A step that was clipped says nothing against the length before it.
      if (!finest) length_ = clipped ? std::max(length_, next) : next;
      until_ = until;
      next_node_ = (turn.rotation * node_).normalized();
      return;
    }
    length_ = next;
  }
}

// Turn from 0 to tau.
Quaterniond Attitude::turn(double tau, Motion& motion) {
  if (until_ == never || tau < from_) restart(motion);
  while (tau >= until_ && until_ < course_.end) {
    node_ = next_node_;
    from_ = until_;
    advance(motion);
  }
  if (tau >= until_) return next_node_;
  return tau == from_ ? node_
                      : (turn_over(motion, from_, tau, course_.accuracy).rotation * node_).normalized();
}

Quaterniond Attitude::at(double tau, Motion& motion) {
  if (course_.constant) return exponential(tau * constant_) * start_;
  if (!(tau >= course_.period)) return turn(tau, motion) * start_;
  if (!round_known_) {
    const Quaterniond round = turn(course_.period, motion);
    const double sine = round.vec().stableNorm();
    round_half_angle_ = std::atan2(sine, round.w());
    round_axis_ = sine > 0 ? Vector3d(round.vec() / sine) : Vector3d::Zero();
    round_known_ = true;
  }
  const double rounds = std::floor(tau / course_.period);
  const double rest = std::max(0.0, std::fma(-rounds, course_.period, tau));
  const double angle = rounds * round_half_angle_;
  const Vector3d axis = std::sin(angle) * round_axis_;
  const Quaterniond past(std::cos(angle), axis.x(), axis.y(), axis.z());
  return turn(rest, motion) * past * start_;
}

}  // namespace hybrid_sphere
