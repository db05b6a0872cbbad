#pragma once

#include "hybrid_sphere/sphere/attitude.hpp"

namespace hybrid_sphere {

/// What a step of a rule does to the orientation.
struct Turn {
  Quaterniond rotation;
  double error;  ///< an estimate, in units of what is allowed; 0 by rules of fixed step
};

/// @param accuracy  of SpinRule::magnus, relative to the angle turned
Turn turn_over(SpinRule rule, Motion& motion, double from, double until, double accuracy);

/// Turn by a rotation vector.
Quaterniond exponential(const Vector3d& rotation);

}  // namespace hybrid_sphere
