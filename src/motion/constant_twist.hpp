#pragma once

#include <cmath>

#include "hybrid_sphere/sphere/twist.hpp"

namespace hybrid_sphere {

/// A motion with constant velocities:
///   r(tau) = r_0 + v tau,   q(tau) = exp(omega tau / 2) q_0
/// tau is the time since its beginning [s]: nothing is accumulated. Source: (18), corrected (27); the
/// exponential map is docs/theory.md 6.
class ConstantTwist {
 public:
  ConstantTwist() = default;
  ConstantTwist(const Vector2d& position, const Quaterniond& orientation, const Twist& twist)
      : position_(position), orientation_(orientation), twist_(twist) {
    const double rate =
        std::hypot(twist.angular_velocity.x(), twist.angular_velocity.y(), twist.angular_velocity.z());
    half_rate_ = 0.5 * rate;
    axis_ = rate > 0 ? Vector3d(twist.angular_velocity / rate) : Vector3d::Zero();
  }

  const Vector2d& start() const { return position_; }
  const Twist& twist() const { return twist_; }

  Vector2d position(double tau) const { return position_ + tau * twist_.velocity; }

  /// From now on q(tau) = q_0.
  void hold_orientation() { half_rate_ = 0; }

  Quaterniond orientation(double tau) const {
    const double half_angle = half_rate_ * tau;
    const double sine = std::sin(half_angle);
    const Quaterniond turn(std::cos(half_angle), sine * axis_.x(), sine * axis_.y(), sine * axis_.z());
    return turn * orientation_;
  }

 private:
  Vector2d position_ = Vector2d::Zero();
  Quaterniond orientation_ = Quaterniond::Identity();
  Twist twist_;
  double half_rate_ = 0;              // |omega|/2 [rad/s]
  Vector3d axis_ = Vector3d::Zero();  // omega/|omega|
};

}  // namespace hybrid_sphere
