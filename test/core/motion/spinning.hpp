#pragma once

#include <functional>
#include <utility>

#include "motion/motion.hpp"

namespace hybrid_sphere::testing {

using SpinFunction = std::function<Vector3d(double)>;

/// A motion that has nothing but its angular velocity.
class Spinning : public Motion {
 public:
  explicit Spinning(SpinFunction omega) : omega_(std::move(omega)) {}
  MotionState at(double tau) override {
    ++asked;
    return {{Vector2d::Zero(), Vector2d::Zero(), Vector2d::Zero()}, Vector2d::Zero(), omega_(tau)};
  }
  double acceleration_bound(double, double) override { return 0; }
  double end_before(double) override { return never; }
  MotionEnd end_reason() const override { return MotionEnd::grip_lost; }
  SpinProfile spin_profile() const override { return {}; }

  int asked = 0;

 private:
  SpinFunction omega_;
};

}  // namespace hybrid_sphere::testing
