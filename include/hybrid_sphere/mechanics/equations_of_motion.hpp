#pragma once

#include <Eigen/Core>
#include <string>

#include "hybrid_sphere/export.hpp"
#include "hybrid_sphere/mechanics/vector.hpp"
#include "hybrid_sphere/numerical_error.hpp"

namespace hybrid_sphere::mechanics {

using Matrix = Eigen::MatrixXd;

/// L, Q and the kinematics evaluated at one (t, q, v): the terms of the equations of motion
///   M v' = h + C^T lambda,   q' = rate(q, v)
/// (C^T lambda is the constraints' part, see ConstraintTerms). Source: (3), (9) and (15); docs/theory.md 7.1.
struct MotionTerms {
  double lagrangian = 0;  ///< L [J]
  Vector rate;            ///< q' (N)
  Vector momentum;        ///< p = dL/dv (n)
  Matrix mass;            ///< M = d2L/dv2 (n x n), symmetric
  Vector force;  ///< h = Q + dL/dq - (dp/dq) q' - dp/dt, with the Hamel terms of quasi-velocities (n)
};

/// A Lagrangian system without its constraints, as the engine sees it: numbers at a point. AutomaticEquations
/// differentiates a user's L; a derived class of your own can supply the same terms by hand.
///
/// q are N coordinates, v are n velocities, q' = rate(q, v) linear in v. Usually N = n and q' = v. If v are
/// quasi-velocities (15), such as an angular velocity, N may be larger than n: a quaternion has four
/// components.
/// @code
/// class Particle final : public mechanics::EquationsOfMotion {  // of unit mass, on a line
///  public:
///   mechanics::Index coordinates() const override { return 1; }
///   mechanics::Index velocities() const override { return 1; }
///   void evaluate(double, const mechanics::Vector&, const mechanics::Vector& v,
///                 mechanics::MotionTerms& terms) const override {
///     terms.lagrangian = v[0] * v[0] / 2;
///     terms.rate = terms.momentum = v;
///     terms.mass = mechanics::Matrix::Ones(1, 1);
///     terms.force = mechanics::Vector::Zero(1);
///   }
///   void momentum(double, const mechanics::Vector&, const mechanics::Vector& v, mechanics::Vector& p,
///                 mechanics::Matrix& mass) const override {
///     p = v;
///     mass = mechanics::Matrix::Ones(1, 1);
///   }
/// };
/// @endcode
class HYBRID_SPHERE_EXPORT EquationsOfMotion {
 public:
  virtual ~EquationsOfMotion() = default;

  virtual Index coordinates() const = 0;  ///< N
  virtual Index velocities() const = 0;   ///< n

  /// Fills every field of terms; its vectors keep their memory from call to call.
  /// Throws NotFinite, naming the user function, if one has a value or derivative that is not finite.
  virtual void evaluate(double t, const Vector& q, const Vector& v, MotionTerms& terms) const = 0;

  /// Only p and M, which is what stage 2 needs. Throws NotFinite.
  virtual void momentum(double t, const Vector& q, const Vector& v, Vector& p, Matrix& mass) const = 0;

  /// The number of velocities in each diagonal block of M; outside of these blocks, M is 0 in every state. A
  /// divisor of n; by default n.
  virtual Index mass_block() const { return velocities(); }

  /// q' for the velocities v.
  virtual void rate(const Vector& /*q*/, const Vector& v, Vector& rate) const { rate = v; }

  /// B (N x n) of q' = B(q) v, and the drift (DB v) B v (N), the part of q'' that is there at constant v.
  /// Asked for by holonomic and unilateral constraints alone. By default I and 0; throws std::logic_error
  /// where rate() says otherwise: then this is to be supplied, too.
  virtual void directions(const Vector& q, const Vector& v, Matrix& directions, Vector& drift) const;

  /// Axes S(t) on which v = S c of a steady motion has constant components c, at the present: S (n x n,
  /// regular) and S' (n x n). Asked for by modes() alone. By default I and 0: v itself is constant.
  /// @param acceleration  v' (n)
  virtual void steady_axes(const Vector& q, const Vector& v, const Vector& acceleration, Matrix& axes,
                           Matrix& axes_rate) const;
};

/// A user function returned a value, or has a derivative, that is not finite.
class HYBRID_SPHERE_EXPORT NotFinite : public NumericalError {
 public:
  /// @param function  its name: "lagrangian", "forces", "rate", "constraint blade", "guard of constraint
  /// blade", "derivative of ..."
  explicit NotFinite(const std::string& function)
      : NumericalError(function + " is not finite"), function_(function) {}
  const std::string& function() const { return function_; }

 protected:
  NotFinite(const std::string& function, const std::string& message)
      : NumericalError(message), function_(function) {}

 private:
  std::string function_;
};

/// A part of the model has no meaning at a state, as a disk that lies flat has no point of contact with its
/// plane, and a friction no reaction under a negative load.
class HYBRID_SPHERE_EXPORT Undefined : public NotFinite {
 public:
  /// @param function  its name, as for NotFinite @param message  what is wrong there, with numbers
  Undefined(const std::string& function, const std::string& message) : NotFinite(function, message) {}
};

}  // namespace hybrid_sphere::mechanics
