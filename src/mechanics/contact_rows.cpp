#include "mechanics/contact_rows.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace hybrid_sphere::mechanics {

ContactRows::ContactRows(const Model& model) : model_(&model), motion_(model) {}

void ContactRows::set(const ContactCandidates& candidates) {
  candidates_ = candidates;
  rows_of_frictions_.clear();
  row_count_ = contacts();
  for (const std::size_t friction : candidates.frictions) {
    const Index size = model_->constraints[friction].function->size();
    rows_of_frictions_.push_back({row_count_, size});
    row_count_ += size;
  }
  motion_.set_active(candidates.bilateral);
}

std::size_t ContactRows::constraint(Index row) const {
  if (row < contacts()) return candidates_.contacts[std::size_t(row)];
  std::size_t i = 0;
  while (row >= rows_of_frictions_[i].first + rows_of_frictions_[i].size) ++i;
  return candidates_.frictions[i];
}

Index ContactRows::contact_of(std::size_t friction) const {
  const auto& contact = model_->constraints[friction].friction->contact;
  if (!contact) return -1;
  const auto& all = candidates_.contacts;
  const auto place = std::lower_bound(all.begin(), all.end(), *contact);
  return place != all.end() && *place == *contact ? Index(place - all.begin()) : -1;
}

void ContactRows::evaluate(double t, const Vector& q, const Vector& v) {
  values_.resize(row_count_);
  gamma_.resize(row_count_);
  rows_.resize(row_count_, v.size());
  ConstraintTerms terms;
  for (Index row = 0; row < row_count_; row += terms.value.size()) {
    const Index size = model_->constraints[constraint(row)].function->size();
    model_->constraints[constraint(row)].function->evaluate(t, q, v, motion_.terms().rate, terms);
    values_.segment(row, size) = terms.value;
    gamma_.segment(row, size) = terms.gamma;
    rows_.middleRows(row, size) = terms.gradient;
  }
  for (Index row = 0; row < row_count_; ++row) {
    if (std::isfinite(values_[row]) && std::isfinite(gamma_[row]) && rows_.row(row).allFinite()) continue;
    throw NotFinite("constraint " + model_->constraints[constraint(row)].name);
  }
  directions_ = rows_.transpose();
}

void ContactRows::add_sliding_friction(double t, const Vector& q, const Vector& v) {
  Vector value;
  Matrix gradient;
  for (const Slide& slide : candidates_.sliding) {
    const Constraint& sliding = model_->constraints[slide.constraint];
    const Index row = contact_of(slide.constraint);
    if (row < 0) continue;
    sliding.function->evaluate(t, q, v, value, gradient);
    directions_.col(row) -=
        sliding.friction->coefficient * (gradient.transpose() * slide.heading.head(value.size()));
  }
}

void ContactRows::respond() {
  const Index count = directions_.cols();
  Vector a;
  Vector lambda;
  const Vector no_gamma = Vector::Zero(motion_.gradient().rows());
  responses_.resize(directions_.rows(), count);
  multipliers_.resize(no_gamma.size(), count);
  for (Index j = 0; j < count; ++j) {
    if (!motion_.respond(directions_.col(j), no_gamma, a, lambda)) {
      throw ConstraintError(ConstraintError::Reason::singular, "no velocity of constraint " +
                                                                   model_->constraints[constraint(j)].name +
                                                                   " has a mass: M is singular");
    }
    responses_.col(j) = a;
    multipliers_.col(j) = lambda;
  }
  effect_ = rows_ * responses_;
}

/// Whether the bilateral constraints leave a row no motion but rounding: then it takes no part.
bool ContactRows::is_fixed(Index row) const {
  const Vector mass = motion_.terms().mass.diagonal();
  double free = 0;
  for (Index s = 0; s < mass.size(); ++s) {
    if (mass[s] > 0) free += rows_(row, s) * rows_(row, s) / mass[s];
  }
  return std::abs(rows_.row(row).dot(responses_.col(row))) <= contact_roundoff * free;
}

/// Units in which all rows of C have the same effect on themselves, and the largest free term is 1.
ContactRows::Units ContactRows::units(const Vector& free, const Vector& sizes) const {
  Units units;
  units.scale.resize(row_count_);
  units.free = free;
  for (Index i = 0; i < row_count_; ++i) {
    const double own = rows_.row(i).dot(responses_.col(i));
    units.scale[i] = 1 / std::sqrt(std::max(std::abs(own), DBL_MIN));
  }
  // A cone stays circular: both of its rows have the same unit.
  for (const Rows& rows : rows_of_frictions_) {
    auto scale = units.scale.segment(rows.first, rows.size);
    scale.setConstant(scale.minCoeff());
  }
  for (Index i = 0; i < row_count_; ++i) {
    if (std::abs(free[i]) <= contact_roundoff * sizes[i]) units.free[i] = 0;
    units.free[i] *= units.scale[i];
    if (!is_fixed(i)) units.size = std::max(units.size, std::abs(units.free[i]));
  }
  if (units.size == 0) units.size = 1;
  units.free /= units.size;
  units.effect = units.scale.asDiagonal() * effect_ * units.scale.asDiagonal();
  for (Index i = 0; i < row_count_; ++i) {
    if (!is_fixed(i)) continue;
    units.effect.row(i).setZero();
    units.effect.col(i).setZero();
    units.free[i] = 0;
  }
  return units;
}

std::optional<ContactReactions> ContactRows::solve(const Vector& free, const Vector& sizes,
                                                   const Vector& coefficients, const Vector& limits) const {
  const Units units = this->units(free, sizes);
  ContactEquations equations{units.effect, units.free, contacts()};
  for (std::size_t i = 0; i < candidates_.frictions.size(); ++i) {
    const Rows& rows = rows_of_frictions_[i];
    const double scale = units.scale[rows.first];
    ContactEquations::Cone cone{rows.first, rows.size, contact_of(candidates_.frictions[i])};
    if (cone.contact >= 0) cone.coefficient = coefficients[Index(i)] * units.scale[cone.contact] / scale;
    cone.limit = limits[Index(i)] / (scale * units.size);
    equations.cones.push_back(cone);
  }
  std::optional<ContactReactions> solution = solve_contacts(equations);
  if (solution) solution->reactions = units.size * solution->reactions.cwiseProduct(units.scale);
  return solution;
}

void ContactRows::refuse(double t, const Vector& q) const {
  if (frictions() == 0 && candidates_.sliding.empty()) {
    throw ConstraintError(ConstraintError::Reason::inconsistent,
                          "the unilateral constraints " + names(*model_, candidates_.contacts) +
                              " contradict each other: no reactions satisfy them all, at " +
                              describe(*model_, t, q));
  }
  throw ConstraintError(ConstraintError::Reason::painleve,
                        "no reactions were found that satisfy the unilateral constraints and frictions " +
                            names(*model_, candidates_.contacts) +
                            (frictions() > 0 ? ", " + names(*model_, candidates_.frictions) : "") +
                            " (Painleve), at " + describe(*model_, t, q));
}

}  // namespace hybrid_sphere::mechanics
