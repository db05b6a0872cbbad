#pragma once

#include <memory>
#include <string>

#include "hybrid_sphere/export.hpp"
#include "hybrid_sphere/mechanics/model.hpp"
#include "hybrid_sphere/numerical_error.hpp"

namespace hybrid_sphere::mechanics {

/// Stage 2: velocities just after constraints are suddenly applied.
struct Impulse {
  Vector velocity;     ///< v2 (n)
  Vector multipliers;  ///< Lambda, of the active constraints in their order; of least norm where redundant
  Vector impulse;      ///< P = C(v2)^T Lambda (n)
  Index rank = 0;      ///< of C(v2); less than the number of multipliers where constraints are redundant
  int iterations = 0;  ///< of Newton's method; 1 where the constraints are linear in v and L is quadratic,
                       ///< 0 where they hold already
};

/// Why no motion exists under a set of constraints.
class HYBRID_SPHERE_EXPORT ConstraintError : public NumericalError {
 public:
  enum class Reason {
    singular,      ///< M is not positive definite on the velocities that the constraints leave free
    no_direction,  ///< df/dv = 0: a constraint without velocities, or at a velocity where it has no direction
    inconsistent,  ///< constraints that cannot hold together
    no_velocity,   ///< Newton's method finds no velocity with f = 0
    painleve       ///< sliding friction leaves no reaction that keeps a contact closed
  };
  ConstraintError(Reason reason, const std::string& message) : NumericalError(message), reason_(reason) {}
  Reason reason() const { return reason_; }

 private:
  Reason reason_;
};

/// Solves stage 2,
///   p(t, q, v2) - p(t, q, v1) = C(v2)^T Lambda,   f(t, q, v2) = 0   (t and q stay),
/// by Newton's method from v1 as long as its steps shrink; otherwise in parts along the path f(v) = (1 - s)
/// f(v1), s from 0 to 1. Of several solutions it thus takes the one that v1 leads to, a local minimum of the
/// distance from v1 in the metric of M; if the path ends early, it takes another one, going downhill in this
/// distance and abs(f). With linear f and quadratic L this is a single step: the projection of v1 onto f = 0,
/// orthogonal in the metric of M. If f(v1) = 0 already, up to the rounding of its terms, Lambda is exactly 0
/// and v2 is v1. The same routine keeps stage 3 on f = 0. Source: (6)-(8), closed by the ideality of the
/// impulse; docs/theory.md 7.2, 7.4.
/// @code
/// const auto impulse_of = [](const mechanics::Model& model, const mechanics::Vector& q,
///                            const mechanics::Vector& v) {
///   mechanics::Impulse impulse;
///   mechanics::ImpulseSolver(model).solve({0}, 0, q, v, impulse);  // of the first constraint
///   return impulse.impulse;
/// };
/// @endcode
class HYBRID_SPHERE_EXPORT ImpulseSolver {
 public:
  /// @param model  must outlive the solver
  explicit ImpulseSolver(const Model& model);
  ~ImpulseSolver();
  ImpulseSolver(ImpulseSolver&&) noexcept;

  /// @param active  constraints that hold after the impulse; if empty, nothing changes
  /// Throws ConstraintError, naming the constraints, NotFinite, or std::out_of_range for an index that is not
  /// one of a constraint.
  void solve(const ActiveSet& active, double t, const Vector& q, const Vector& v1, Impulse& result);

  /// max over the active constraints' functions of abs(f) / sum over s of abs(C_s v_s): a dimensionless
  /// measure of how far v is off the constraints. 0 where f = 0, infinite where f is not 0 but the sum is.
  double relative_residual(const ActiveSet& active, double t, const Vector& q, const Vector& v);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hybrid_sphere::mechanics
