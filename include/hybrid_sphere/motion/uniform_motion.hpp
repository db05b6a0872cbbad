#pragma once

#include <cmath>

#include "hybrid_sphere/motion/motion.hpp"

namespace hybrid_sphere {

/// Motion between two switches on still, unforced ground, free or rolling: both velocities are constant.
///   r(tau) = r_0 + v tau,   q(tau) = exp(omega tau / 2) q_0
/// tau is the time since the beginning of the segment [s]: nothing is accumulated. Source: (18), corrected
/// (27); the exponential map is docs/theory.md 6.
class UniformMotion final : public Motion {
 public:
  UniformMotion() = default;
  /// @param radius  of the sphere [m]
  UniformMotion(const Vector2d& position, const Quaterniond& orientation, const Twist& twist, double radius)
      : position_(position), orientation_(orientation), twist_(twist), radius_(radius) {
    const double rate =
        std::hypot(twist.angular_velocity.x(), twist.angular_velocity.y(), twist.angular_velocity.z());
    half_rate_ = 0.5 * rate;
    axis_ = rate > 0 ? Vector3d(twist.angular_velocity / rate) : Vector3d::Zero();
  }

  const Vector2d& start() const { return position_; }
  const Twist& twist() const { return twist_; }

  Vector2d position(double tau) const { return position_ + tau * twist_.velocity; }

  Quaterniond orientation(double tau) const {
    const double half_angle = half_rate_ * tau;
    const double sine = std::sin(half_angle);
    const Quaterniond turn(std::cos(half_angle), sine * axis_.x(), sine * axis_.y(), sine * axis_.z());
    return turn * orientation_;
  }

  MotionState at(double tau) override {
    const Vector3d& omega = twist_.angular_velocity;
    const Vector2d nu = radius_ * Vector2d(omega.y(), -omega.x());
    return {{position(tau), twist_.velocity, Vector2d::Zero()}, twist_.velocity - nu, omega};
  }
  Curve curve() const override {
    Curve curve;
    curve.form = CurveForm::parabola;
    curve.start = position_;
    curve.velocity = curve.line = twist_.velocity;
    return curve;
  }
  double acceleration_bound(double /*from*/, double /*until*/) override { return 0; }
  double end_before(double /*horizon*/) override { return never; }
  /// Never asked for: it has no end.
  MotionEnd end_reason() const override { return MotionEnd::grip_lost; }
  SpinProfile spin_profile() const override {
    SpinProfile profile;
    profile.constant = true;
    return profile;
  }

 private:
  Vector2d position_ = Vector2d::Zero();
  Quaterniond orientation_ = Quaterniond::Identity();
  Twist twist_;
  double radius_ = 1;                 // [m]
  double half_rate_ = 0;              // |omega|/2 [rad/s]
  Vector3d axis_ = Vector3d::Zero();  // omega/|omega|
};

}  // namespace hybrid_sphere
