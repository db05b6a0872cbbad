#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "hybrid_sphere/export.hpp"
#include "hybrid_sphere/mechanics/equations_of_motion.hpp"

namespace hybrid_sphere::mechanics {

/// The terms of constraints f(t, q, v) = 0 at a point; differentiated once, the constraints are C v' = gamma.
struct ConstraintTerms {
  Vector value;     ///< f (g)
  Matrix gradient;  ///< C = df/dv (g x n), also the direction of the reaction C^T lambda (Chetaev)
  Vector gamma;     ///< -(df/dq) q' - df/dt (g)
};

/// g functions f_beta(t, q, v) that vanish together; they may depend on v in any way. Source: (5).
class HYBRID_SPHERE_EXPORT ConstraintFunction {
 public:
  virtual ~ConstraintFunction() = default;

  virtual Index size() const = 0;  ///< g

  /// Fills terms. @param rate  q' (N). Throws NotFinite.
  virtual void evaluate(double t, const Vector& q, const Vector& v, const Vector& rate,
                        ConstraintTerms& terms) const = 0;

  /// Only the value and the gradient, which is what stage 2 needs. Throws NotFinite.
  virtual void evaluate(double t, const Vector& q, const Vector& v, Vector& value,
                        Matrix& gradient) const = 0;

  /// Adds the sum over beta of Lambda_beta d2f_beta/dv2 to `sum` (n x n). Throws NotFinite.
  virtual void add_curvature(double t, const Vector& q, const Vector& v, const Vector& multipliers,
                             Matrix& sum) const = 0;

  /// Returns false if column s of C is 0 in every state. By default true. Systems of many bodies are solved
  /// faster if their equations have small mass blocks and their constraints few velocities.
  virtual bool depends_on(Index /*s*/) const { return true; }

  /// Whether f is the rate of functions g(t, q) that vanish, too.
  virtual bool has_position() const { return false; }
  /// Their values (g), where there are any. Throws NotFinite.
  virtual void position(double /*t*/, const Vector& /*q*/, Vector& value) const { value.setZero(size()); }
};

/// g(t, q): a constraint with a guard holds while the guard is positive.
class HYBRID_SPHERE_EXPORT Guard {
 public:
  virtual ~Guard() = default;

  /// g. Throws NotFinite.
  virtual double value(double t, const Vector& q) const = 0;
  /// dg/dt along the motion, (dg/dq) q' + dg/dt. Throws NotFinite.
  virtual double rate(double t, const Vector& q, const Vector& q_rate) const = 0;
};

/// When a constraint holds: for t in [begin, end), while its guard, if it has one, is positive.
struct Schedule {
  double begin = -std::numeric_limits<double>::infinity();  ///< [s]
  double end = std::numeric_limits<double>::infinity();     ///< [s]
  std::shared_ptr<const Guard> guard;                       ///< null: the interval alone
};

/// N(t, q, v) >= 0, the load of a friction [N]. A motion ends where it becomes negative (Stop::undefined).
class HYBRID_SPHERE_EXPORT Load {
 public:
  virtual ~Load() = default;
  /// N. Throws NotFinite.
  virtual double value(double t, const Vector& q, const Vector& v) const = 0;
};

/// Coulomb's law for a constraint f = 0 of one or two functions, the slip velocity: it holds as long as
/// abs(lambda) <= mu_s N. Beyond, it slides, and lambda = -mu N f/abs(f). Source: docs/theory.md 7.8.
struct Friction {
  double coefficient = 0;                      ///< mu >= 0, of what slides
  std::optional<double> static_coefficient{};  ///< mu_s >= mu, of what sticks; none: mu
  std::optional<std::size_t> contact;  ///< whose multiplier is N: the index of a unilateral constraint
  std::shared_ptr<const Load> load;    ///< N, where no contact is given

  double of_sticking() const { return static_coefficient.value_or(coefficient); }  ///< mu_s
};

/// Makes a constraint of one function unilateral: f is the rate of a gap g(t, q) >= 0 (position() gives it)
/// and the schedule's guard is -g. The constraint holds where g = 0, as long as lambda >= 0. Source:
/// docs/theory.md 7.8.
struct Unilateral {
  double restitution = 0;  ///< Poisson's, 0 to 1: impulse of the restitution over that of the compression
};

/// A named condition on the motion; its g functions are applied and released together.
/// @code
/// mechanics::Constraint stop{"stop", nullptr, {}};
/// stop.schedule.begin = 2;  // from t = 2 s on
/// @endcode
struct Constraint {
  std::string name;
  std::shared_ptr<const ConstraintFunction> function;
  Schedule schedule;
  std::optional<Unilateral> unilateral{};  ///< none: lambda may have any sign
  std::optional<Friction> friction{};      ///< none: lambda may have any size
};

}  // namespace hybrid_sphere::mechanics
