#pragma once

#include "motion/constant_twist.hpp"
#include "motion/motion.hpp"

namespace hybrid_sphere {

/// Motion between two switches on still, unforced ground, free or rolling: both velocities are constant.
class UniformMotion final : public Motion {
 public:
  UniformMotion() = default;
  /// @param radius  of the sphere [m]
  UniformMotion(const Vector2d& position, const Quaterniond& orientation, const Twist& twist, double radius)
      : path_(position, orientation, twist), radius_(radius) {}

  const ConstantTwist& constant_twist() const { return path_; }
  const Vector2d& start() const { return path_.start(); }
  const Twist& twist() const { return path_.twist(); }
  Vector2d position(double tau) const { return path_.position(tau); }
  Quaterniond orientation(double tau) const { return path_.orientation(tau); }

  /// From now on the orientation stays as it is at the start.
  void hold_orientation() { path_.hold_orientation(); }

  MotionState at(double tau) override {
    const Vector3d& omega = twist().angular_velocity;
    const Vector2d nu = radius_ * Vector2d(omega.y(), -omega.x());
    return {{position(tau), twist().velocity, Vector2d::Zero()}, twist().velocity - nu, omega};
  }
  Curve curve() const override {
    Curve curve;
    curve.form = CurveForm::parabola;
    curve.start = start();
    curve.velocity = curve.line = twist().velocity;
    return curve;
  }
  double acceleration_bound(double /*from*/, double /*until*/) override { return 0; }
  double end_before(double /*horizon*/) override { return never; }
  /// Never called: the motion has no end.
  MotionEnd end_reason() const override { return MotionEnd::grip_lost; }
  SpinProfile spin_profile() const override {
    SpinProfile profile;
    profile.constant = true;
    return profile;
  }

 private:
  ConstantTwist path_;
  double radius_ = 1;  // [m]
};

}  // namespace hybrid_sphere
