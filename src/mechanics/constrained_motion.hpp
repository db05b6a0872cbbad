#pragma once

#include <cstdint>
#include <vector>

#include "hybrid_sphere/mechanics/impulse.hpp"
#include "hybrid_sphere/mechanics/model.hpp"
#include "mechanics/active_constraints.hpp"
#include "mechanics/kept_rows.hpp"
#include "mechanics/metric.hpp"
#include "mechanics/saddle_point.hpp"
#include "mechanics/schur_complement.hpp"
#include "mechanics/sliding_friction.hpp"

namespace hybrid_sphere::mechanics {

/// Stages 1 and 3 at one instant, under the constraints that hold:
///   M v' - C^T lambda = h,   C v' = gamma,   q' = rate(q, v).
/// Source: (3), (9)-(10), differentiated once (index 1); docs/theory.md 7.1.
class ConstrainedMotion {
 public:
  /// @param model  must outlive this object
  explicit ConstrainedMotion(const Model& model);

  const Model& model() const { return *model_; }

  void set_active(const ActiveSet& active, const Slides& sliding = {});
  /// Sets the direction of friction from the slips at (t, q, v). To be called at the start of a step.
  void aim(double t, const Vector& q, const Vector& v) {
    if (!friction_.is_empty()) friction_.aim(t, q, v);
  }
  const ActiveSet& active() const { return constraints_.active(); }
  const SlidingFriction& friction() const { return friction_; }
  SlidingFriction& friction() { return friction_; }

  /// Throws ConstraintError, naming the constraints, or NotFinite, also if v' or lambda is not. Allocates
  /// nothing after the first call with this active set, unless constraints are redundant, unilateral with
  /// sliding friction, or holonomic.
  /// @param step  redundant constraints contradict each other if the velocities show it, beyond their
  ///              rounding, within this time [s]
  void evaluate(double t, const Vector& q, const Vector& v, double step);

  /// The same at a state that is off the constraints by the error of a step: redundant constraints may then
  /// contradict each other by that much; least squares distributes the contradiction.
  void evaluate_stage(double t, const Vector& q, const Vector& v);

  /// Lets evaluate_stage() and project() go by these rows of C, on which all others depend; null: by all.
  /// evaluate() goes by all again.
  void keep_rows(KeptRows::Rows rows) { kept_.set(std::move(rows)); }
  /// After evaluate(): rows of C that are independent of one another, ascending. All rows, if reactions have
  /// limits, which all of them share.
  std::vector<Index> independent_rows() const;

  // What the last evaluate() found.
  const MotionTerms& terms() const { return terms_; }
  const Matrix& gradient() const { return gradient_; }          ///< C (g x n), of the active constraints
  const Vector& acceleration() const { return acceleration_; }  ///< v' (n)
  /// lambda, as Model::multipliers(); 0 where a constraint neither holds nor slides.
  Vector multipliers() const;
  /// What the rounding of forces that cancel may do to v', in the metric of M.
  double acceleration_rounding() const;
  /// lambda of a constraint that holds; of several functions, its length.
  double multiplier(std::size_t constraint) const;
  /// The change of v' (n) by a force (n) and of gamma (g), and of lambda (g), without sliding friction.
  /// @return  false where the equations are singular or not finite
  bool respond(const Vector& force, const Vector& gamma, Vector& acceleration, Vector& lambda);
  /// Size of the terms of which that lambda consists.
  double multiplier_size(std::size_t constraint) const;
  /// Bound on the round-off of that lambda: forces that cancel elsewhere may be all that it consists of.
  double multiplier_rounding(std::size_t constraint) const;
  double residual() const;  ///< max abs(f) over the active constraints
  double energy(const Vector& v) const { return v.dot(terms_.momentum) - terms_.lagrangian; }
  double kinetic_energy(const Vector& v) const { return 0.5 * squared_length(terms_.mass, v); }
  /// Throws NotFinite if an energy is not.
  void require_finite_energy(const Vector& v) const;
  /// The smallest pivot of M relative to its diagonal; where M alone is not far from singular, of M on the
  /// velocities that the constraints leave free.
  double regularity() const {
    return is_regular_ ? schur_complement_.regularity() : saddle_point_.regularity();
  }
  /// The largest v_i among velocities with C v = 0 and a kinetic energy of 1/2.
  double mobility(Index i) const {
    return is_regular_ ? schur_complement_.mobility(i) : saddle_point_.mobility(i);
  }

  /// Of all evaluations so far.
  struct Effort {
    std::uint64_t evaluations = 0;
    double regularity = 1;          ///< the smallest
    double least_regular_time = 0;  ///< t of that [s]
  };
  const Effort& effort() const { return effort_; }

  /// The active constraint to which a row of C belongs.
  std::size_t owner(Index row) const;

  /// Puts (q, v) onto the coordinates' manifold and the active constraints, by stage 2. Source:
  /// docs/theory.md 7.5. Throws what ImpulseSolver::solve throws.
  void project(double t, Vector& q, Vector& v);

 private:
  void evaluate_terms(double t, const Vector& q, const Vector& v);
  SaddlePoint::Outcome solve(double t);
  bool solve_by_kept_rows();
  void add_friction_of_contacts(double t, const Vector& q);
  void distribute_reactions(double t, const Vector& q, const Vector& v);
  void remove_slips_across(Vector& v);
  bool project_by_kept_rows(double t, const Vector& q, Vector& v);
  void project_by_all_rows(double t, Vector& q, Vector& v);
  bool find_way(const Vector& missing, Vector& way);
  bool project_position(double t, Vector& q, const Vector& v);
  Vector missing_positions(double t, const Vector& q) const;
  bool project_by_newton(double t, const Vector& q, Vector& v, bool is_decomposed);
  Vector sizes_of_gamma(double t, const Vector& q, const Vector& v, double step) const;
  void require_finite_forces() const;
  Index row_of(std::size_t constraint) const;
  double mobility_along(Index row) const;
  [[noreturn]] void refuse(SaddlePoint::Outcome outcome, double t, const Vector& q) const;

  const Model* model_;
  MotionTerms terms_;
  ActiveConstraints constraints_;
  std::vector<ConstraintTerms> constraint_terms_;
  Vector value_;  // f
  Matrix gradient_;
  Vector gamma_;
  Vector acceleration_;
  Vector lambda_;
  SlidingFriction friction_;
  Vector force_;             // with the friction of known loads
  bool is_regular_ = false;  // whether schur_complement_ has solved the last equations, or saddle_point_
  SchurComplement schur_complement_;
  SaddlePoint saddle_point_;
  KeptRows kept_;
  Vector kept_multipliers_;
  ImpulseSolver impulse_;
  Impulse projected_;
  Effort effort_;
  bool has_positions_ = false;  // whether a constraint that holds is the rate of one on positions
};

/// Spreads the stacked multipliers of the active constraints over all constraints of the model; 0 elsewhere.
Vector spread(const Model& model, const ActiveSet& active, const Vector& stacked);

}  // namespace hybrid_sphere::mechanics
