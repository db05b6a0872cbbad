#pragma once

#include "motion/attitude.hpp"

namespace hybrid_sphere {

/// The effect of one step of a rule on the orientation.
struct Turn {
  Quaterniond rotation;
  double error;  ///< an estimate [rad]
  double angle;  ///< turned, an estimate [rad]
};

/// @param accuracy  of SpinRule::magnus, relative to the angle turned
Turn turn_over(SpinRule rule, Motion& motion, double from, double until, double accuracy);

/// At this accuracy and looser, SpinRule::magnus takes the difference between one step and two half steps as
/// its error, ignoring the gain by extrapolation: long steps are then safe, and one step suffices between two
/// nodes.
inline constexpr double loose_accuracy = 5e-11;

/// The same over part of an accepted step, from its beginning, at least cost.
Quaterniond turn_within_step(SpinRule rule, Motion& motion, double from, double until, double accuracy);

/// Turn by a rotation vector.
Quaterniond exponential(const Vector3d& rotation);

}  // namespace hybrid_sphere
