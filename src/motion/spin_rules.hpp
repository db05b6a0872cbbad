#pragma once

#include "motion/attitude.hpp"

namespace hybrid_sphere {

/// The effect of one step of a fixed-step rule on the orientation.
struct Turn {
  Quaterniond rotation;
  double error;  ///< an estimate, by comparison with Magnus' method of order 6 [rad]
  double angle;  ///< turned, an estimate [rad]
};

Turn turn_over(SpinRule rule, Motion& motion, double from, double until);

/// The same over part of a step, from its beginning, at least cost.
Quaterniond turn_within_step(SpinRule rule, Motion& motion, double from, double until);

/// Turn by a rotation vector.
Quaterniond exponential(const Vector3d& rotation);

}  // namespace hybrid_sphere
