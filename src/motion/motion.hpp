#pragma once

#include <cstdint>
#include <limits>

#include "motion/curve.hpp"
#include "sphere/constants.hpp"

namespace hybrid_sphere {

/// Place and velocity of the centre at an instant.
struct PointState {
  Vector2d position;      ///< [m]
  Vector2d velocity;      ///< [m/s]
  Vector2d acceleration;  ///< [m/s^2]
};

/// All that a motion fixes at an instant, but the orientation.
struct MotionState {
  PointState center;
  Vector2d contact_velocity;  ///< sigma [m/s]
  Vector3d angular_velocity;  ///< omega [rad/s], on the fixed axes
};

/// Where a derivative changes so suddenly that a quadrature with longer steps would not see it.
struct RapidChange {
  double time = never;   ///< [s]
  double width = never;  ///< time in which it changes; 0 where that is the end of the motion [s]
};

/// How the orientation follows from the angular velocity.
enum class SpinRule : std::uint8_t {
  magnus,    ///< Magnus' method of order 8, steps by the accuracy
  euler,     ///< Euler's method on the quaternion, which is made unit after each step
  rk4,       ///< the classical Runge-Kutta method, likewise
  midpoint,  ///< the exponential map of the rotation at half a step, of order 2
  rkmk4      ///< Runge-Kutta-Munthe-Kaas of order 4
};

/// What is known beforehand of a motion's angular velocity, and what is wanted.
struct SpinProfile {
  double kink = never;    ///< where its derivative jumps; no step goes across [s]
  double end = never;     ///< end of the motion, if known; nothing beyond it is evaluated [s]
  double period = never;  ///< after which it repeats itself for ever [s]
  bool constant = false;
  double scale = never;  ///< time in which the motion changes; the first step is not longer [s]
  double corner = 0;     ///< around which the derivative may change within corner_width [s]
  double corner_width = never;
  /// Error wanted, relative to the angle turned; no less than 1e-16 is to be had. Closed forms ask for that
  /// by default, and for less the looser `solver.accuracy` is (docs/theory.md 6).
  double accuracy = 1e-16;
  SpinRule rule = SpinRule::magnus;
  double step = never;                    ///< of the other rules [s]
  std::uint64_t max_steps = 100'000'000;  ///< that reach() takes, each a good part of a radian
};

/// Why a motion ends of itself.
enum class MotionEnd : std::uint8_t {
  slip_used_up,  ///< sliding, skidding: the slip is 0
  grip_lost,     ///< rolling or sticking: the reaction reaches mu N
  roll_used_up,  ///< rolling, sliding: the resistance has used up nu
  breaks_loose,  ///< sticking, skidding: the resistance cannot keep nu at 0 any more
  edge_left,     ///< edge slide: one of the two grounds lets the sphere go
};

/// How the sphere moves between two switches, as a function of the time tau since the beginning of the
/// segment. Evaluated from there and never from an output before, so that a trajectory does not depend on
/// when it is looked at.
class Motion {
 public:
  virtual ~Motion() = default;

  /// @param tau  >= 0, not beyond the end [s]
  virtual MotionState at(double tau) = 0;
  virtual PointState center(double tau) { return at(tau).center; }
  /// The same with the velocity that is the derivative of the place, to rounding: what is integrated in long
  /// steps keeps the place of a cubic whose derivative is not its velocity.
  virtual PointState path(double tau) { return center(tau); }
  virtual Vector3d angular_velocity(double tau) { return at(tau).angular_velocity; }

  /// The velocity of the ground, where that of the centre is computed from it and a slip: it has their
  /// rounding, also where they leave nothing of each other [m/s].
  virtual Vector2d reference_velocity() { return Vector2d::Zero(); }

  /// Its path, as far as that has a simple form.
  virtual Curve curve() const { return {}; }

  /// A bound on the length of the centre's acceleration between two times, and of the path's [m/s^2].
  virtual double acceleration_bound(double from, double until) = 0;

  /// The same for its component along a direction of any length [that of the direction x m/s^2].
  virtual double acceleration_bound_along(const Vector2d& direction, double from, double until) {
    return direction.norm() * acceleration_bound(from, until);
  }

  /// When the motion ends of itself (slip used up, grip lost, at rest ...): that time if it is not later than
  /// `horizon`, else `never`.
  virtual double end_before(double horizon) = 0;
  /// Why it ends, once end_before has found when.
  virtual MotionEnd end_reason() const = 0;

  /// What is known of the angular velocity beforehand; the rule, its step, accuracy and scale are the
  /// caller's.
  virtual SpinProfile spin_profile() const = 0;

  /// The first rapid change of the angular velocity in (from, until] that is not known beforehand.
  virtual RapidChange rapid_change(double /*from*/, double /*until*/) { return {}; }

  /// No later time may be asked for: there the motion may be too large for numbers [s].
  virtual double last_time() const { return never; }

  /// Whether a method integrates it; else it has a closed form.
  virtual bool is_integrated() const { return false; }

  /// Number of steps of a method between two times that have been reached; 0 where there is a closed form.
  virtual std::uint64_t steps(double /*from*/, double /*until*/) const { return 0; }

  /// Right-hand sides evaluated so far; 0 where there is a closed form.
  virtual std::uint64_t evaluations() const { return 0; }
};

}  // namespace hybrid_sphere
