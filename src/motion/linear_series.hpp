#pragma once

#include "motion/linear_motion.hpp"

namespace hybrid_sphere {

/// Dense output of a linear motion with exponentials: the same to rounding, from Taylor polynomials on
/// intervals [i, i + 1) 2^k s, which depend on the motion alone; the states are therefore the same to the
/// last bit however often they are requested. An interval costs about as much as three evaluations of the
/// motion. Source: docs/theory.md 4.4.
class LinearSeries final : public Motion {
 public:
  /// @param motion  must outlive this object, or its next begin()
  void begin(LinearMotion& motion);

  MotionState at(double tau) override;
  Vector3d angular_velocity(double tau) override { return motion_->angular_velocity(tau); }
  int expand_spin(double middle, double half, polynomials::Powers<3>& powers) override {
    return motion_->expand_spin(middle, half, powers);
  }
  double acceleration_bound(double from, double until) override {
    return motion_->acceleration_bound(from, until);
  }
  double end_before(double horizon) override { return motion_->end_before(horizon); }
  MotionEnd end_reason() const override { return motion_->end_reason(); }
  SpinProfile spin_profile() const override { return motion_->spin_profile(); }
  double last_time() const override { return motion_->last_time(); }

 private:
  LinearMotion* motion_ = nullptr;
  double width_ = 1;       // of the intervals, a power of two [s]
  double until_ = -never;  // of the present one [s]
  LinearMotion::Expansion expansion_{0, 0, {}};
};

}  // namespace hybrid_sphere
