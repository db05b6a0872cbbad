#include "mechanics/constrained_motion.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "mechanics/decompositions/linear_equations.hpp"
#include "mechanics/impulse_equations.hpp"
#include "mechanics/indeterminate_reactions.hpp"

namespace hybrid_sphere::mechanics {

ConstrainedMotion::ConstrainedMotion(const Model& model)
    : model_(&model), constraints_(model), friction_(model), impulse_(model) {}

void ConstrainedMotion::set_active(const ActiveSet& active, const Slides& sliding) {
  constraints_.set(active);
  friction_.set(active, sliding);
  has_positions_ = false;
  is_regular_ = false;
  constraint_terms_.resize(active.size());
  Index rows = 0;
  for (const std::size_t i : active) {
    const ConstraintFunction& function = *model_->constraints[i].function;
    rows += function.size();
    has_positions_ = has_positions_ || function.has_position();
  }
  gradient_.setZero(rows, model_->equations->velocities());
  gamma_.setZero(rows);
  acceleration_.setZero(model_->equations->velocities());
  lambda_.setZero(rows);
  force_.setZero(model_->equations->velocities());
  kept_.set(nullptr);
  schur_complement_.set_pattern(BlockPattern::of(*model_, active));
}

std::vector<Index> ConstrainedMotion::independent_rows() const {
  const auto has_limits = [this](std::size_t i) {
    return model_->constraints[i].unilateral || model_->constraints[i].friction;
  };
  const bool are_all =
      is_regular_ || !friction_.is_empty() || std::any_of(active().begin(), active().end(), has_limits);
  if (!are_all) return saddle_point_.independent_rows();
  std::vector<Index> all(static_cast<std::size_t>(gradient_.rows()));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

void ConstrainedMotion::evaluate(double t, const Vector& q, const Vector& v, double step) {
  kept_.set(nullptr);
  evaluate_terms(t, q, v);
  SaddlePoint::Outcome outcome = solve(t);
  if (outcome == SaddlePoint::Outcome::inconsistent) {
    const Vector sizes = sizes_of_gamma(t, q, v, step);
    outcome = saddle_point_.solve(terms_.mass, gradient_, force_, gamma_, acceleration_, lambda_, &sizes);
  }
  if (outcome == SaddlePoint::Outcome::inconsistent || outcome == SaddlePoint::Outcome::singular) {
    refuse(outcome, t, q);
  }
  add_friction_of_contacts(t, q);
  if (outcome == SaddlePoint::Outcome::redundant) distribute_reactions(t, q, v);
  require_finite_forces();
}

void ConstrainedMotion::evaluate_stage(double t, const Vector& q, const Vector& v) {
  evaluate_terms(t, q, v);
  if (!kept_.are_all() && solve_by_kept_rows()) return;
  const SaddlePoint::Outcome outcome = solve(t);
  if (outcome == SaddlePoint::Outcome::inconsistent) {
    saddle_point_.solve_step(terms_.mass, terms_.mass, gradient_, force_, gamma_, gamma_, acceleration_,
                             lambda_);
  }
  if (outcome == SaddlePoint::Outcome::singular) refuse(outcome, t, q);
  add_friction_of_contacts(t, q);
  if (outcome == SaddlePoint::Outcome::redundant) distribute_reactions(t, q, v);
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

void ConstrainedMotion::evaluate_terms(double t, const Vector& q, const Vector& v) {
  ++effort_.evaluations;
  model_->equations->evaluate(t, q, v, terms_);
  Index row = 0;
  for (std::size_t i = 0; i < active().size(); ++i) {
    const ConstraintFunction& function = *model_->constraints[active()[i]].function;
    ConstraintTerms& terms = constraint_terms_[i];
    function.evaluate(t, q, v, terms_.rate, terms);
    const Index size = function.size();
    constraints_.copy_gradient(i, row, terms.gradient, gradient_);
    for (Index j = 0; j < size; ++j, ++row) gamma_[row] = terms.gamma[j];
  }
  force_ = terms_.force;
  if (!friction_.is_empty()) friction_.evaluate(t, q, v, force_);
}

/// @return  whether these rows are independent of one another here; otherwise they are kept no longer
bool ConstrainedMotion::solve_by_kept_rows() {
  Vector& multipliers = kept_multipliers_;
  const Vector& gamma = kept_.of(gamma_);
  is_regular_ = schur_complement_.decompose(terms_.mass, gradient_, kept_.rows()) &&
                schur_complement_.solve(force_, gamma, acceleration_, multipliers);
  if (!is_regular_ && saddle_point_.solve(terms_.mass, kept_.of(gradient_), force_, gamma, acceleration_,
                                          multipliers) != SaddlePoint::Outcome::regular) {
    kept_.set(nullptr);
    return false;
  }
  kept_.spread(multipliers, lambda_);
  require_finite_forces();
  return true;
}

SaddlePoint::Outcome ConstrainedMotion::solve(double t) {
  SaddlePoint::Outcome outcome = SaddlePoint::Outcome::regular;
  is_regular_ = schur_complement_.decompose(terms_.mass, gradient_) &&
                schur_complement_.solve(force_, gamma_, acceleration_, lambda_);
  if (!is_regular_) {
    outcome = saddle_point_.solve(terms_.mass, gradient_, force_, gamma_, acceleration_, lambda_);
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

bool ConstrainedMotion::respond(const Vector& force, const Vector& gamma, Vector& acceleration,
                                Vector& lambda) {
  acceleration.resize(force.size());
  lambda.resize(gamma.size());
  if (!kept_.are_all()) throw std::logic_error("friction where rows of C are left out");
  if (is_regular_) return schur_complement_.solve(force, gamma, acceleration, lambda);
  const SaddlePoint::Outcome outcome =
      saddle_point_.solve(terms_.mass, gradient_, force, gamma, acceleration, lambda);
  return (outcome == SaddlePoint::Outcome::regular || outcome == SaddlePoint::Outcome::redundant) &&
         acceleration.allFinite() && lambda.allFinite();
}

/// Where friction is proportional to the reactions N of contacts: its effect is linear in them, and they are
/// found from N = N0 + (effect on N) N.
void ConstrainedMotion::add_friction_of_contacts(double t, const Vector& q) {
  const std::vector<SlidingFriction::Contact>& contacts = friction_.contacts();
  if (contacts.empty()) return;
  constexpr double least = 1e-9;
  const Index count = static_cast<Index>(contacts.size());
  Matrix accelerations(acceleration_.size(), count);
  Matrix multipliers(lambda_.size(), count);
  const Vector no_gamma = Vector::Zero(lambda_.size());
  Vector a;
  Vector lambda;
  for (Index k = 0; k < count; ++k) {
    if (!respond(contacts[std::size_t(k)].direction, no_gamma, a, lambda)) throw NotFinite("friction");
    accelerations.col(k) = a;
    multipliers.col(k) = lambda;
  }
  Matrix system = Matrix::Identity(count, count);
  Vector load(count);
  for (Index k = 0; k < count; ++k) {
    const Index row = contacts[std::size_t(k)].row;
    system.row(k) -= multipliers.row(row);
    load[k] = lambda_[row];
  }
  for (Index k = 0; k < count; ++k) {
    if (system(k, k) > least) continue;
    const std::size_t contact = contacts[std::size_t(k)].constraint;
    ActiveSet slides;
    for (const Slide& slide : friction_.sliding()) {
      if (model_->constraints[slide.constraint].friction->contact == contact)
        slides.push_back(slide.constraint);
    }
    throw ConstraintError(ConstraintError::Reason::painleve,
                          "sliding with friction " + names(*model_, slides) +
                              " leaves no reaction of constraint " + model_->constraints[contact].name +
                              " that keeps it (Painleve), at " + describe(*model_, t, q));
  }
  load = solve_linear_equations(system, load);
  acceleration_ += accelerations * load;
  lambda_ += multipliers * load;
  if (!(acceleration_.allFinite() && lambda_.allFinite())) throw NotFinite("friction");
}

/// Reactions within their limits, where the motion leaves a choice.
void ConstrainedMotion::distribute_reactions(double t, const Vector& q, const Vector& v) {
  const auto has_limits = [this](std::size_t i) {
    return model_->constraints[i].unilateral || model_->constraints[i].friction;
  };
  if (std::none_of(active().begin(), active().end(), has_limits)) return;
  Matrix directions = gradient_.transpose();
  for (const SlidingFriction::Contact& contact : friction_.contacts()) {
    directions.col(contact.row) += contact.direction;
  }
  lambda_ = within_limits(*model_, active(), t, q, v, directions, saddle_point_.rank(), lambda_);
}

Index ConstrainedMotion::row_of(std::size_t constraint) const {
  Index row = 0;
  for (std::size_t i = 0; active()[i] != constraint; ++i) {
    row += model_->constraints[active()[i]].function->size();
  }
  return row;
}

double ConstrainedMotion::acceleration_rounding() const {
  constexpr double roundings = 4 * DBL_EPSILON;
  double square = 0;
  for (Index s = 0; s < acceleration_.size(); ++s) {
    if (!(terms_.mass(s, s) > 0)) continue;
    double force = std::abs(terms_.force[s]) + std::abs(force_[s]);
    for (Index row = 0; row < lambda_.size(); ++row) force += std::abs(gradient_(row, s) * lambda_[row]);
    square += force * force / terms_.mass(s, s);
  }
  return roundings * std::sqrt(square);
}

double ConstrainedMotion::multiplier(std::size_t constraint) const {
  const Index size = model_->constraints[constraint].function->size();
  const Index row = row_of(constraint);
  return size == 1 ? lambda_[row] : lambda_.segment(row, size).norm();
}

/// The acceleration along a row of C by a force of 1 along it, by the diagonal of M [1/kg].
double ConstrainedMotion::mobility_along(Index row) const {
  double mobility = 0;
  for (Index s = 0; s < acceleration_.size(); ++s) {
    const double c = gradient_(row, s);
    if (terms_.mass(s, s) > 0) mobility += c * c / terms_.mass(s, s);
  }
  return mobility;
}

double ConstrainedMotion::multiplier_rounding(std::size_t constraint) const {
  // The equations of lambda are a matrix of the order of the number of constraints: their solution has the
  // round-off of some sums, here of 16.
  constexpr double sums = 16;
  constexpr double of_distribution = 1e-13;  // of the largest, where the motion leaves a choice of them
  const double roundings = sums * acceleration_rounding();
  const Index first = row_of(constraint);
  double sum = 0;
  if (saddle_point_.rank() < lambda_.size()) sum = of_distribution * lambda_.lpNorm<Eigen::Infinity>();
  for (Index row = first; row < first + model_->constraints[constraint].function->size(); ++row) {
    const double mobility = mobility_along(row);
    if (mobility > 0) sum += roundings / std::sqrt(mobility);
  }
  return sum;
}

double ConstrainedMotion::multiplier_size(std::size_t constraint) const {
  const Index first = row_of(constraint);
  double sum = 0;
  for (Index row = first; row < first + model_->constraints[constraint].function->size(); ++row) {
    const double acceleration =
        std::abs(gamma_[row]) + gradient_.row(row).cwiseAbs().dot(acceleration_.cwiseAbs());
    const double mobility = mobility_along(row);
    sum += std::abs(lambda_[row]) + (mobility > 0 ? acceleration / mobility : 0);
  }
  return sum;
}

Vector ConstrainedMotion::multipliers() const {
  Vector all = spread(*model_, active(), lambda_);
  friction_.add_multipliers(all);
  return all;
}

double ConstrainedMotion::residual() const {
  double largest = 0;
  for (const ConstraintTerms& terms : constraint_terms_) {
    largest = std::max(largest, terms.value.lpNorm<Eigen::Infinity>());
  }
  return largest;
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
