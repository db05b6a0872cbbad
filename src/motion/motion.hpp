#pragma once

#include <cstdint>
#include <limits>

#include "motion/curve.hpp"
#include "motion/polynomials.hpp"
#include "sphere/constants.hpp"

namespace hybrid_sphere {

/// Place and velocity of the centre at an instant.
struct PointState {
  Vector2d position;      ///< [m]
  Vector2d velocity;      ///< [m/s]
  Vector2d acceleration;  ///< [m/s^2]
};

/// All that a motion determines at an instant, except the orientation.
struct MotionState {
  PointState center;
  Vector2d contact_velocity;  ///< sigma [m/s]
  Vector3d angular_velocity;  ///< omega [rad/s], on the fixed axes
};

/// A change of a derivative so sudden that a quadrature with longer steps would miss it.
struct RapidChange {
  double time = never;   ///< [s]
  double width = never;  ///< time in which it changes; 0 if this is the end of the motion [s]
};

/// How the orientation follows from the angular velocity.
enum class SpinRule : std::uint8_t {
  series,    ///< polynomials on panels of time, as long as the accuracy allows
  euler,     ///< Euler's method on the quaternion, normalized after each step
  rk4,       ///< the classical Runge-Kutta method, likewise
  midpoint,  ///< the exponential map of the angular velocity at mid-step, of order 2
  rkmk4      ///< Runge-Kutta-Munthe-Kaas of order 4
};

/// What is known in advance about a motion's angular velocity, and what is required.
struct SpinProfile {
  double kink = never;    ///< where its derivative jumps; no step crosses it [s]
  double end = never;     ///< end of the motion, if known; nothing beyond it is evaluated [s]
  double period = never;  ///< after which it repeats itself indefinitely [s]
  bool constant = false;
  bool linear = false;   ///< in time, but for the kink
  double scale = never;  ///< time in which the motion changes; bounds the first step [s]
  double corner = 0;     ///< around which the derivative may change within corner_width [s]
  double corner_width = never;
  /// Requested error, relative to the angle turned; 1e-16 is the least possible. Closed forms request that by
  /// default, and less accuracy the looser `solver.accuracy` is (docs/theory.md 6).
  double accuracy = 1e-16;
  double noise = 0;      ///< errors that the angular velocity has anyway [rad/s]
  double frequency = 0;  ///< of its phase, whose rounding grows with the time [1/s]
  SpinRule rule = SpinRule::series;
  double step = never;                    ///< of the other rules [s]
  std::uint64_t max_steps = 100'000'000;  ///< that reach() takes, each a good part of a radian
};

/// Motion::expand_spin() where the angular velocity is linear in time.
/// @param now   at the middle [rad/s]
/// @param rate  its derivative [rad/s^2]
inline int expand_linear_spin(const Vector3d& now, const Vector3d& rate, double half,
                              polynomials::Powers<3>& powers) {
  powers.col(0) = now;
  powers.col(1) = half * rate;
  return 2;
}

/// Why a motion ends by itself.
enum class MotionEnd : std::uint8_t {
  slip_used_up,  ///< sliding, skidding: the slip is 0
  grip_lost,     ///< rolling or sticking: the reaction reaches mu N
  roll_used_up,  ///< rolling, sliding: the resistance has used up nu
  breaks_loose,  ///< sticking, skidding: the resistance cannot keep nu at 0 any more
  edge_left,     ///< edge slide: one of the two grounds lets the sphere go
};

/// How the sphere moves between two switches, as a function of the time tau since the beginning of the
/// segment. Evaluated from there and never from an earlier output, so that a trajectory does not depend on
/// when it is sampled.
class Motion {
 public:
  virtual ~Motion() = default;

  /// @param tau  >= 0, not beyond the end [s]
  virtual MotionState at(double tau) = 0;
  virtual PointState center(double tau) { return at(tau).center; }
  /// The same, with a velocity that is the derivative of the place to rounding: a motion integrated in long
  /// steps has places on a cubic whose derivative is not the motion's velocity.
  virtual PointState path(double tau) { return center(tau); }
  virtual Vector3d angular_velocity(double tau) { return at(tau).angular_velocity; }

  /// The velocity of the ground, if that of the centre is computed from it and a slip: the result carries
  /// their rounding, even if they cancel [m/s].
  virtual Vector2d reference_velocity() { return Vector2d::Zero(); }

  /// Its path, if that has a simple form.
  virtual Curve curve() const { return {}; }

  /// A bound on the length of the centre's acceleration between two times, and of the path's [m/s^2].
  virtual double acceleration_bound(double from, double until) = 0;

  /// The same for its component along a direction of any length [that of the direction x m/s^2].
  virtual double acceleration_bound_along(const Vector2d& direction, double from, double until) {
    return direction.norm() * acceleration_bound(from, until);
  }

  /// When the motion ends by itself (slip used up, grip lost, at rest ...): that time if it is not later than
  /// `horizon`, otherwise `never`.
  virtual double end_before(double horizon) = 0;
  /// Why it ends, once end_before has found when.
  virtual MotionEnd end_reason() const = 0;

  /// What is known in advance about the angular velocity; the caller sets the rule, its step, accuracy and
  /// scale.
  virtual SpinProfile spin_profile() const = 0;

  /// Sets the first columns of `powers` to the Taylor polynomial of the angular velocity in
  /// x = (tau - middle)/half [rad/s]. No kink may lie at x from -1 to 1.
  /// @return their number, all further powers are 0; 0 if there is no simple way to them, or the motion
  /// changes
  ///         in less than half
  virtual int expand_spin(double /*middle*/, double /*half*/, polynomials::Powers<3>& /*powers*/) {
    return 0;
  }

  /// The first rapid change of the angular velocity in (from, until] that is not known in advance.
  virtual RapidChange rapid_change(double /*from*/, double /*until*/) { return {}; }

  /// The last time that may be requested: after it, numbers may overflow [s].
  virtual double last_time() const { return never; }

  /// Whether it is integrated numerically; otherwise it has a closed form.
  virtual bool is_integrated() const { return false; }

  /// Number of integration steps between two times that have been reached; 0 for a closed form.
  virtual std::uint64_t steps(double /*from*/, double /*until*/) const { return 0; }

  /// Number of right-hand sides evaluated so far; 0 for a closed form.
  virtual std::uint64_t evaluations() const { return 0; }
};

}  // namespace hybrid_sphere
