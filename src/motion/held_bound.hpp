#pragma once

#include "motion/speed_bound.hpp"

namespace hybrid_sphere::numeric {

/// t = F.J e with F = Instant::forcing, by which e turns: de/dx = t J e. If w = v (Equations::holds_velocity)
/// and e equals F/abs(F) to within rounding, it is 0: such an e stays there.
double turning(const Equations& equations, const Instant& now, const Vector2d& e);

/// Bounds on a motion against dry friction on ground at rest, w = v (Equations::holds_velocity), where drive
/// and friction may nearly cancel. With v = abs(v) e, v' = F - A e and F' = -gamma v - lambda v' - q (abs(v)
/// v)', t = F.J e, and x the variable of integration, dt = dx/abs(v),
///   abs(v)' = F.e - A,   de/dx = t J e,
///   d(F.e)/dx = abs(v) F'.e + t^2,   dt/dx = -(F.e + abs(v) (lambda + q abs(v))) t.
/// So friction subtracts A from all growth, F.e decreases by no more than F changes, and t only decays while
/// F.e is positive: if t is 0, the motion stays on its line. Source: docs/theory.md 4.5.
struct HeldBound {
  double speed;         ///< abs(v) [m/s]
  double growth;        ///< abs(F.e - A), of the speed [m/s^2]
  double turning;       ///< abs(de/dx) [m/s^2]
  double turning_bend;  ///< abs(d^2e/dx^2) [m^2/s^4]

  /// @param y         the state at the beginning
  /// @param x         length in x
  /// @param duration  in which the time grows by so much [s]
  /// @param coarse    bounds for the same duration
  HeldBound(const Equations& equations, const State& y, double x, double duration, const SpeedBound& coarse);
};

}  // namespace hybrid_sphere::numeric
