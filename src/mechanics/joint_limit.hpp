#pragma once

#include <memory>
#include <string>

#include "mechanics/body_constraint.hpp"
#include "mechanics/joint_axis.hpp"

namespace hybrid_sphere::mechanics {

/// A bound of the coordinate of a joint, as a gap >= 0: sign (coordinate - bound).
struct JointBound {
  std::shared_ptr<const JointAxis> axis;
  double sign;   ///< 1: a lower bound, -1: an upper bound
  double bound;  ///< [rad or m]

  double gap(const AxisMotion& motion) const { return sign * (motion.value - bound); }
};

/// The rate of the gap; lambda: the torque or the force on the second body away from the bound.
class LimitConstraint final : public BodyConstraint {
 public:
  LimitConstraint(const std::string& label, JointBound bound)
      : BodyConstraint(label, bound.axis->bodies[0], bound.axis->bodies[1], 1), bound_(std::move(bound)) {}

  bool has_position() const override { return true; }
  void position(double t, const Vector& q, Vector& value) const override;

 protected:
  void fill(const Bodies& bodies, BodyRows& rows) const override;

 private:
  JointBound bound_;
};

/// Less the gap, as Unilateral requires.
class LimitGuard final : public Guard {
 public:
  LimitGuard(std::string label, JointBound bound) : label_(std::move(label)), bound_(std::move(bound)) {}

  double value(double t, const Vector& q) const override;
  double rate(double t, const Vector& q, const Vector& q_rate) const override;

 private:
  std::string label_;
  JointBound bound_;
};

}  // namespace hybrid_sphere::mechanics
