#pragma once

#include "hybrid_sphere/mechanics/solution.hpp"
#include "mechanics/constrained_motion.hpp"

namespace hybrid_sphere::mechanics {

/// The equations of motion at states near one, put onto the constraints that hold there.
class NearbyStates {
 public:
  /// @param model  must outlive this object @param state  checked
  NearbyStates(const Model& model, const State& state);

  /// Puts (q, v) onto the constraints and evaluates the equations there. Throws NumericalError.
  void move_to(const Vector& q, const Vector& v);
  const Vector& q() const { return q_; }
  const Vector& v() const { return v_; }
  const ConstrainedMotion& motion() const { return motion_; }

  /// B (N x n) of q' = B v.
  Matrix directions() const;
  /// B' (N x n) at the rate of q.
  Matrix directions_rate() const;
  /// The change of x' = (q', v') by a change of (q, v) along which the constraints hold (N + n), to first
  /// order. The present state stays.
  Vector change_of_rate(const Vector& direction);
  /// The changes of g (first) and f of the constraints that hold, by q along each column of B S (N x n).
  Matrix changes_of_constraints(const Matrix& directions);
  /// How large v' would be if nothing cancelled, in the metric of the diagonal of M.
  double size_of_acceleration() const;
  /// Square roots of the diagonal of M (n); 1 where there is no mass.
  Vector weights() const;

 private:
  Vector constraints_at(const Vector& q);
  Vector roundoff_of_rate() const;

  double time_;
  ConstrainedMotion motion_;
  ActiveConstraints constraints_;
  Vector q_;
  Vector v_;
};

}  // namespace hybrid_sphere::mechanics
