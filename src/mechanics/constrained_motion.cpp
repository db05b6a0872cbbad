#include "mechanics/constrained_motion.hpp"

#include <algorithm>
#include <cmath>

#include "mechanics/impulse_equations.hpp"

namespace hybrid_sphere::mechanics {

ConstrainedMotion::ConstrainedMotion(const Model& model)
    : model_(&model), constraints_(model), impulse_(model) {}

void ConstrainedMotion::set_active(const ActiveSet& active) {
  constraints_.set(active);
  is_regular_ = false;
  constraint_terms_.resize(active.size());
  Index rows = 0;
  for (const std::size_t i : active) rows += model_->constraints[i].function->size();
  gradient_.setZero(rows, model_->equations->velocities());
  gamma_.setZero(rows);
  acceleration_.setZero(model_->equations->velocities());
  lambda_.setZero(rows);
}

void ConstrainedMotion::evaluate(double t, const Vector& q, const Vector& v, double step) {
  SaddlePoint::Outcome outcome = solve(t, q, v);
  if (outcome == SaddlePoint::Outcome::inconsistent) {
    const Vector sizes = sizes_of_gamma(t, q, v, step);
    outcome =
        saddle_point_.solve(terms_.mass, gradient_, terms_.force, gamma_, acceleration_, lambda_, &sizes);
  }
  if (outcome == SaddlePoint::Outcome::inconsistent || outcome == SaddlePoint::Outcome::singular) {
    refuse(outcome, t, q);
  }
  require_finite_forces();
}

void ConstrainedMotion::evaluate_stage(double t, const Vector& q, const Vector& v) {
  const SaddlePoint::Outcome outcome = solve(t, q, v);
  if (outcome == SaddlePoint::Outcome::inconsistent) {
    saddle_point_.solve_step(terms_.mass, terms_.mass, gradient_, terms_.force, gamma_, gamma_, acceleration_,
                             lambda_);
  }
  if (outcome == SaddlePoint::Outcome::singular) refuse(outcome, t, q);
  require_finite_forces();
}

// Terms that are finite may overflow on the way to these.
void ConstrainedMotion::require_finite_forces() const {
  if (is_regular_) return;  // checked by then
  if (!acceleration_.allFinite()) throw NotFinite("the acceleration");
  for (Index row = 0; row < lambda_.size(); ++row) {
    if (!std::isfinite(lambda_[row])) {
      throw NotFinite("the multiplier of constraint " + model_->constraints[owner(row)].name);
    }
  }
}

void ConstrainedMotion::require_finite_energy(const Vector& v) const {
  if (!(std::isfinite(energy(v)) && std::isfinite(kinetic_energy(v)))) throw NotFinite("the energy");
}

SaddlePoint::Outcome ConstrainedMotion::solve(double t, const Vector& q, const Vector& v) {
  ++effort_.evaluations;
  model_->equations->evaluate(t, q, v, terms_);
  Index row = 0;
  for (std::size_t i = 0; i < active().size(); ++i) {
    const ConstraintFunction& function = *model_->constraints[active()[i]].function;
    ConstraintTerms& terms = constraint_terms_[i];
    function.evaluate(t, q, v, terms_.rate, terms);
    const Index size = function.size();
    gradient_.middleRows(row, size) = terms.gradient;
    gamma_.segment(row, size) = terms.gamma;
    row += size;
  }
  SaddlePoint::Outcome outcome = SaddlePoint::Outcome::regular;
  is_regular_ = schur_complement_.decompose(terms_.mass, gradient_) &&
                schur_complement_.solve(terms_.force, gamma_, acceleration_, lambda_);
  if (!is_regular_) {
    outcome = saddle_point_.solve(terms_.mass, gradient_, terms_.force, gamma_, acceleration_, lambda_);
  }
  if (regularity() < effort_.regularity) {
    effort_.regularity = regularity();
    effort_.least_regular_time = t;
  }
  return outcome;
}

// gamma is a sum whose terms may cancel to nothing but their rounding: each coordinate's share tells between
// coordinates. Within a user's formula nothing does; there counts what gamma does to the velocities.
Vector ConstrainedMotion::sizes_of_gamma(double t, const Vector& q, const Vector& v, double step) const {
  Vector sizes = gradient_.cwiseAbs() * v.cwiseAbs() / step;
  Vector direction = Vector::Zero(q.size());
  ConstraintTerms at_rest;
  ConstraintTerms moving;
  Index row = 0;
  for (const std::size_t i : active()) {
    const ConstraintFunction& function = *model_->constraints[i].function;
    auto size = sizes.segment(row, function.size());
    function.evaluate(t, q, v, direction, at_rest);
    size += at_rest.gamma.cwiseAbs();
    for (Index j = 0; j < q.size(); ++j) {
      direction[j] = terms_.rate[j];
      function.evaluate(t, q, v, direction, moving);
      size += (moving.gamma - at_rest.gamma).cwiseAbs();
      direction[j] = 0;
    }
    row += function.size();
  }
  return sizes;
}

void ConstrainedMotion::refuse(SaddlePoint::Outcome outcome, double t, const Vector& q) const {
  if (outcome == SaddlePoint::Outcome::singular) {
    throw ConstraintError(
        ConstraintError::Reason::singular,
        "the mass matrix M = d2L/dv2 is not positive definite on the velocities that are left free, at " +
            describe(*model_, t, q));
  }
  ActiveSet conflict;
  for (const Index row : saddle_point_.conflict()) {
    if (conflict.empty() || conflict.back() != owner(row)) conflict.push_back(owner(row));
  }
  throw ConstraintError(ConstraintError::Reason::inconsistent,
                        "the constraints " + names(*model_, conflict) +
                            " contradict each other: no acceleration satisfies them all, at " +
                            describe(*model_, t, q));
}

std::size_t ConstrainedMotion::owner(Index row) const {
  Index end = 0;
  for (const std::size_t i : active()) {
    end += model_->constraints[i].function->size();
    if (row < end) return i;
  }
  return active().back();
}

Vector ConstrainedMotion::multipliers() const { return spread(*model_, active(), lambda_); }

double ConstrainedMotion::residual() const {
  double largest = 0;
  for (const ConstraintTerms& terms : constraint_terms_) {
    largest = std::max(largest, terms.value.lpNorm<Eigen::Infinity>());
  }
  return largest;
}

void ConstrainedMotion::project(double t, Vector& q, Vector& v) {
  if (model_->normalize) model_->normalize(q);
  if (active().empty() || project_by_newton(t, q, v)) return;
  impulse_.solve(active(), t, q, v, projected_);
  v = projected_.velocity;
}

/// By the mass matrix of the last evaluation, which has been near here.
/// @return  whether that succeeds in a step or two; otherwise v is unchanged
bool ConstrainedMotion::project_by_newton(double t, const Vector& q, Vector& v) {
  constexpr int few = 3;
  if (!is_regular_) return false;
  projected_.velocity = v;
  for (int i = 0; i < few; ++i) {
    constraints_.evaluate(t, q, projected_.velocity, value_, gradient_);
    if (residual_of(value_, gradient_, projected_.velocity) <= strict_tolerance(v.size())) {
      if ((gradient_.array() == 0).rowwise().all().any()) return false;
      v = projected_.velocity;
      return true;
    }
    if (!schur_complement_.decompose(terms_.mass, gradient_)) return false;
    schur_complement_.add_shortest(-value_, projected_.velocity);
  }
  return false;
}

Vector spread(const Model& model, const ActiveSet& active, const Vector& stacked) {
  Vector all = Vector::Zero(model.multipliers());
  Index row = 0;
  for (const std::size_t i : active) {
    const Index size = model.constraints[i].function->size();
    all.segment(model.multiplier_of(i), size) = stacked.segment(row, size);
    row += size;
  }
  return all;
}

}  // namespace hybrid_sphere::mechanics
