#pragma once

#include "motion/attitude.hpp"

namespace hybrid_sphere {

/// What a step of a rule does to the orientation.
struct Turn {
  Quaterniond rotation;
  double error;  ///< an estimate [rad]
  double angle;  ///< turned, an estimate [rad]
};

/// @param accuracy  of SpinRule::magnus, relative to the angle turned
Turn turn_over(SpinRule rule, Motion& motion, double from, double until, double accuracy);

/// From here on SpinRule::magnus takes the difference of one step and two half ones for its error, without
/// what the extrapolation gains: long steps are safe then, and one step is enough between two nodes.
inline constexpr double loose_accuracy = 5e-11;

/// The same over a part of a step that has been accepted, from its beginning, at least cost.
Quaterniond turn_within_step(SpinRule rule, Motion& motion, double from, double until, double accuracy);

/// Turn by a rotation vector.
Quaterniond exponential(const Vector3d& rotation);

}  // namespace hybrid_sphere
