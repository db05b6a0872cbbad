#pragma once

#include "motion/equations.hpp"

namespace hybrid_sphere::numeric {

/// What drives the centre, apart from drag: v' = drive - stiffness (d - d_0) + ... at the place d_0.
struct Drive {
  Vector2d drive;    ///< [m/s^2]
  double friction;   ///< of constant length [m/s^2]
  double stiffness;  ///< gamma [1/s^2]
  bool conserves;    ///< whether the drive and the stiffness come from a potential, and nothing else drives
};

/// @param d  d_0
Drive drive_of(const Equations& equations, const Vector2d& d);

/// Bound on abs(v) where abs(v)' <= alpha + gamma abs(d - d_0): the speed of d'' = alpha + gamma d.
/// @param start      abs(v) at the beginning [m/s]
/// @param stiffness  gamma [1/s^2]
double driven_speed(double start, double alpha, double stiffness, double duration);

/// Bounds on the lengths of v, v', v'', nu' and nu'' of a motion for a duration after a state. Drag only
/// slows the centre down, a turntable turns its velocity, so that abs(v)' <= alpha + gamma abs(d - d_0) with
/// gamma from the spring and the ground's share in drag of the spin; the solution of d'' = alpha + gamma d is
/// the bound. In rolling nu = v - u(r); while the sphere slides, friction and torques change nu, and drag
/// slows it. A bound may be infinite, but is never NaN.
struct SpeedBound {
  double speed;         ///< [m/s]
  double acceleration;  ///< [m/s^2]
  double jerk;          ///< but for the turning of a dry friction [m/s^3]
  double roll;          ///< abs(nu'); 0 where nothing depends on nu [m/s^2]
  double roll_rate;     ///< abs(nu''), likewise [m/s^3]

  /// @param y         the state at the beginning
  /// @param duration  >= 0 [s]
  SpeedBound(const Equations& equations, const State& y, double duration);

  /// Tightens the bounds on speed and acceleration if w = v (Equations::holds_velocity).
  void limit(const Equations& equations, double by_speed, double by_acceleration);

 private:
  void bound_jerk(const Equations& equations);
  void bound_roll(const Equations& equations, const State& y, double duration);
};

/// Bounds on derivatives of f and g by the time, given bounds on those of v.
struct ForcingBound {
  double force_rate;  ///< abs(f')
  double spin_rate;   ///< abs(g')
  double force_bend;  ///< abs(f'')
  double spin_bend;   ///< abs(g'')

  ForcingBound(const Equations& equations, const SpeedBound& bound);

  /// Bound on the rate of Instant::forcing while skidding or rolling against a resistance [m/s^3].
  double forcing_rate(const Equations& equations, const SpeedBound& bound) const;
};

}  // namespace hybrid_sphere::numeric
