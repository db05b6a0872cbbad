#include "mechanics/initial_positions.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "mechanics/active_constraints.hpp"
#include "mechanics/constraint_residual.hpp"
#include "mechanics/guards.hpp"
#include "mechanics/saddle_point.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::mechanics {
namespace {

// Newton's method takes 3 to 6 steps from positions that are rounded. Near a singular position its steps only
// halve the error: 50 of them lead from 1 to round-off.
constexpr int max_position_steps = 50;

// A step of Newton's method must be shorter than the one before by this factor, as that of an impulse.
constexpr double position_contraction = 0.75;

// Steps of this part of the coordinates are round-off.
constexpr double position_step_roundoff = 2 * DBL_EPSILON;

/// Newton's method for positions on constraints.
class PositionSearch {
 public:
  PositionSearch(const Model& model, const ActiveSet& holding, double t, const Vector& v)
      : model_(model), constraints_(model), t_(t), v_(v) {
    constraints_.set(holding);
  }

  /// Moves q until the steps are round-off, or do not shrink any more.
  void run(Vector& q) {
    Vector way = Vector::Zero(v_.size());  // from the start, as displacements along the velocities
    double previous = std::numeric_limits<double>::infinity();
    for (int i = 0; i < max_position_steps; ++i) {
      if (!find_way(q, way)) return;
      const Vector step = next_ - way;
      const double length = saddle_point_.length(step);
      if (!(length < position_contraction * previous)) return;
      previous = length;
      way = next_;
      model_.equations->rate(q, step, rate_);
      const bool is_roundoff = (rate_.array().abs() <= position_step_roundoff * q.array().abs()).all();
      q += rate_;
      if (model_.normalize) model_.normalize(q);
      if (is_roundoff) return;
    }
  }

 private:
  /// The whole displacement w: M w = C^T lambda and C w = C (the way so far) - g, with M, C and g at q.
  /// @return  whether it exists
  bool find_way(const Vector& q, const Vector& way) {
    model_.equations->momentum(t_, q, v_, momentum_, mass_);
    constraints_.evaluate(t_, q, v_, value_, gradient_);
    Vector target = gradient_ * way;
    Index row = 0;
    for (const std::size_t i : constraints_.active()) {
      const Constraint& constraint = model_.constraints[i];
      constraint.function->position(t_, q, position_);
      if (!position_.allFinite()) throw NotFinite("position of constraint " + constraint.name);
      target.segment(row, position_.size()) -= position_;
      row += position_.size();
    }
    // Constraints that say the same contradict each other by the error of the data: least squares decide.
    const SaddlePoint::Outcome outcome = saddle_point_.solve_step(
        mass_, mass_, gradient_, Vector::Zero(v_.size()), target, target, next_, multipliers_);
    return outcome != SaddlePoint::Outcome::singular;
  }

  const Model& model_;
  ActiveConstraints constraints_;
  SaddlePoint saddle_point_;
  double t_;
  const Vector& v_;
  Vector next_;
  Vector rate_;
  Vector momentum_;
  Matrix mass_;
  Vector value_;
  Matrix gradient_;
  Vector position_;
  Vector multipliers_;
};

}  // namespace

ActiveSet holonomic_at_start(const Model& model, double t, const Vector& q,
                             const std::optional<ActiveSet>& known) {
  ActiveSet set;
  for (std::size_t i = 0; i < model.constraints.size(); ++i) {
    const Constraint& constraint = model.constraints[i];
    if (!constraint.function->has_position()) continue;
    if (known ? contains(*known, i) : has_held(constraint.schedule, t, q)) set.push_back(i);
  }
  return set;
}

Vector positions_on(const Model& model, const ActiveSet& holding, double t, const Vector& q, const Vector& v,
                    double allowed) {
  Vector result = q;
  const Vector given = q.cwiseAbs();
  PositionSearch(model, holding, t, v).run(result);
  for (const std::size_t i : holding) {
    const Constraint& constraint = model.constraints[i];
    const double off = relative_position(constraint, t, result, v, result.cwiseAbs().cwiseMax(given));
    if (off <= allowed) continue;
    throw std::invalid_argument("the initial positions cannot be put onto the constraints " +
                                names(model, holding) + ": Newton's method ends off " + constraint.name +
                                " by " + text::shortest(off) +
                                " of its terms; allowed: positions nearer to "
                                "them (" +
                                describe(model, t, q) + ")");
  }
  return result;
}

}  // namespace hybrid_sphere::mechanics
