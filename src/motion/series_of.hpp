#pragma once

#include "motion/motion.hpp"

namespace hybrid_sphere {

/// Dense output of a motion of type M: outputs from polynomials, the same to rounding; all else is the
/// motion's.
template <class M>
class SeriesOf : public Motion {
 public:
  int expand_spin(double middle, double half, polynomials::Powers<3>& powers) override {
    return motion_->expand_spin(middle, half, powers);
  }
  Vector3d angular_velocity(double tau) override { return motion_->angular_velocity(tau); }
  double acceleration_bound(double from, double until) override {
    return motion_->acceleration_bound(from, until);
  }
  double end_before(double horizon) override { return motion_->end_before(horizon); }
  MotionEnd end_reason() const override { return motion_->end_reason(); }
  SpinProfile spin_profile() const override { return motion_->spin_profile(); }
  double last_time() const override { return motion_->last_time(); }

 protected:
  M* motion_ = nullptr;
};

}  // namespace hybrid_sphere
