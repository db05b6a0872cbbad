#pragma once

#include <vector>

#include "hybrid_sphere/mechanics/impulse.hpp"
#include "hybrid_sphere/mechanics/solution.hpp"
#include "hybrid_sphere/numerical_error.hpp"
#include "mechanics/segment.hpp"

namespace hybrid_sphere::mechanics {

/// Constraints apply and release one another endlessly at one instant.
class LivelockError : public NumericalError {
 public:
  using NumericalError::NumericalError;
};

/// Decides at one instant which constraints hold, and applies their impulses: the only place where stages
/// switch. Source: docs/theory.md 7.6.
class ActiveSetRules {
 public:
  /// @param model     must outlive this object
  /// @param accuracy  of the motion, relative to its scale
  ActiveSetRules(const Model& model, double accuracy);

  /// At the start of the motion: constraints whose guards are positive hold already, as do those whose
  /// intervals began before t. Nothing is applied yet. Throws NotFinite.
  ActiveSet begin(double t, const Vector& q);

  /// Brings the constraints up to date at (t, q).
  /// @param v        in: the velocities before; out: those after the last impulse
  /// @param sizes    of the numbers from which q was computed (N): q carries their rounding
  /// @param ahead    how far to look ahead if velocities do not determine a guard's sign [s]
  /// @param impulses receives a Switch for each change, without its index
  /// @return         constraints that hold from now on
  /// Throws ConstraintError, NotFinite or LivelockError; v, active() and impulses are then those of the last
  /// change that was possible.
  const ActiveSet& switch_constraints(double t, const Vector& q, Vector& v, const Vector& sizes, double ahead,
                                      std::vector<Switch>& impulses);

  const ActiveSet& active() const { return active_; }
  /// The guards, with their present signs, of constraints that are within their intervals, except guards that
  /// the active constraints keep at 0.
  std::vector<MonitoredGuard> monitored(double t, const Vector& q, const Vector& v, const Vector& sizes);

  /// The first begin or end of an interval after t; infinity if there is none.
  double next_instant(double t) const;

 private:
  bool in_interval(std::size_t i, double t) const;
  bool is_kept(std::size_t i, double t, const Vector& q, const Vector& v, const Vector& sizes);
  int sign_ahead(std::size_t i, double t, const Vector& q, const Vector& v, const Vector& sizes,
                 double ahead);
  void see_sides(double t, const Vector& q, const Vector& v_before, const Vector& v, const Vector& sizes,
                 double ahead);
  ActiveSet holding(double t) const;
  Switch apply(const ActiveSet& next, double t, const Vector& q, const Vector& v);

  const Model* model_;
  ImpulseSolver impulse_;
  ConstrainedMotion motion_;
  double looseness_;            // the accuracy, in units of the rounding for which sign_of allows
  std::vector<bool> positive_;  // sides of the guards; true without a guard
  std::vector<bool> kept_;  // guards that the motion so far should have kept at 0: they are off by its errors
  std::vector<double> released_;  // t at which the guard changed to negative last [s]
  ActiveSet active_;
};

}  // namespace hybrid_sphere::mechanics
