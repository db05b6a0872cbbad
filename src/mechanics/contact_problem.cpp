#include "mechanics/contact_problem.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>

#include "interrupt/interrupt.hpp"
#include "mechanics/sliding_friction.hpp"

namespace hybrid_sphere::mechanics {
namespace {

constexpr double contact_roundoff = 1e-12;
constexpr double noise = 1e-9;  // of steps that do not get shorter any more

}  // namespace

ContactProblem::ContactProblem(const Model& model) : model_(&model), motion_(model), bilateral_(model) {}

std::size_t ContactProblem::constraint(Index row) const {
  if (row < contacts()) return candidates_.contacts[std::size_t(row)];
  std::size_t i = 0;
  while (row >= rows_of_frictions_[i].first + rows_of_frictions_[i].size) ++i;
  return candidates_.frictions[i];
}

/// The row of the contact that loads a friction; -1: its load is known, or the contact does not touch.
Index ContactProblem::contact_of(std::size_t friction) const {
  const auto& contact = model_->constraints[friction].friction->contact;
  if (!contact) return -1;
  const auto& all = candidates_.contacts;
  const auto place = std::lower_bound(all.begin(), all.end(), *contact);
  return place != all.end() && *place == *contact ? Index(place - all.begin()) : -1;
}

void ContactProblem::set(const ContactCandidates& candidates) {
  candidates_ = candidates;
  rows_of_frictions_.clear();
  row_count_ = contacts();
  for (const std::size_t friction : candidates.frictions) {
    const Index size = model_->constraints[friction].function->size();
    rows_of_frictions_.push_back({row_count_, size});
    row_count_ += size;
  }
  bilateral_.set(candidates.bilateral);
  motion_.set_active(candidates.bilateral);
}

void ContactProblem::evaluate_rows(double t, const Vector& q, const Vector& v) {
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

/// To be called after an evaluation of the motion.
void ContactProblem::respond_to_rows() {
  const Index count = directions_.cols();
  Vector a;
  Vector lambda;
  const Vector no_gamma = Vector::Zero(bilateral_.size());
  responses_.resize(directions_.rows(), count);
  multipliers_.resize(bilateral_.size(), count);
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

void ContactProblem::evaluate_accelerations(double t, const Vector& q, const Vector& v) {
  Slides known;
  for (const Slide& slide : candidates_.sliding) {
    if (!model_->constraints[slide.constraint].friction->contact) known.push_back(slide);
  }
  motion_.set_active(candidates_.bilateral, known);
  motion_.evaluate_stage(t, q, v);
  evaluate_rows(t, q, v);
  const Vector acceleration = motion_.acceleration();
  free_ = rows_ * acceleration - gamma_;
  free_sizes_ = rows_.cwiseAbs() * acceleration.cwiseAbs() + gamma_.cwiseAbs();
  Vector value;
  Matrix gradient;
  for (const Slide& slide : candidates_.sliding) {
    const Constraint& sliding = model_->constraints[slide.constraint];
    if (!sliding.friction->contact) continue;
    for (Index row = 0; row < contacts(); ++row) {
      if (constraint(row) != *sliding.friction->contact) continue;
      sliding.function->evaluate(t, q, v, value, gradient);
      directions_.col(row) -=
          sliding.friction->coefficient * (gradient.transpose() * slide.heading.head(value.size()));
    }
  }
  respond_to_rows();
}

/// The coefficient of a friction that does not slip: of sticking, unless it has broken loose. Its reaction is
/// then at its limit, where rounding would decide: it cannot hold any more.
double ContactProblem::coefficient(std::size_t friction) const {
  constexpr double hold = 1 - 1e-9;  // above the rounding of reactions, of which this leaves slips six digits
  const Friction& law = *model_->constraints[friction].friction;
  if (!contains(candidates_.loose, friction)) return law.of_sticking();
  return std::min(law.coefficient, hold * law.of_sticking());
}

/// mu N of the frictions whose loads are known; 0 for others.
Vector ContactProblem::known_limits(double t, const Vector& q, const Vector& v) const {
  Vector limits = Vector::Zero(frictions());
  for (Index i = 0; i < frictions(); ++i) {
    const std::size_t constraint = candidates_.frictions[std::size_t(i)];
    const Friction& friction = *model_->constraints[constraint].friction;
    if (friction.contact) continue;
    limits[i] = coefficient(constraint) * load_of(*model_, friction, t, q, v, Vector());
  }
  return limits;
}

/// Whether the bilateral constraints leave a row no motion but rounding: then it takes no part.
bool ContactProblem::is_fixed(Index row) const {
  const Vector mass = motion_.terms().mass.diagonal();
  double free = 0;
  for (Index s = 0; s < mass.size(); ++s) {
    if (mass[s] > 0) free += rows_(row, s) * rows_(row, s) / mass[s];
  }
  return std::abs(rows_.row(row).dot(responses_.col(row))) <= contact_roundoff * free;
}

/// Units in which all rows of C have the same effect on themselves, and the largest free term is 1.
ContactProblem::Units ContactProblem::units(const Vector& free, const Vector& sizes) const {
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

/// @param limits  of frictions, besides mu N
std::optional<ContactReactions> ContactProblem::solve(const Vector& free, const Vector& sizes,
                                                      const Vector& limits, Sticking sticking) {
  const Units units = this->units(free, sizes);
  ContactEquations equations{units.effect, units.free, contacts()};
  for (std::size_t i = 0; i < candidates_.frictions.size(); ++i) {
    const Rows& rows = rows_of_frictions_[i];
    const std::size_t friction = candidates_.frictions[i];
    const double mu = sticking == Sticking::rests ? coefficient(friction)
                                                  : model_->constraints[friction].friction->coefficient;
    const double scale = units.scale[rows.first];
    ContactEquations::Cone cone{rows.first, rows.size, contact_of(candidates_.frictions[i])};
    if (cone.contact >= 0) cone.coefficient = mu * units.scale[cone.contact] / scale;
    cone.limit = limits[Index(i)] / (scale * units.size);
    equations.cones.push_back(cone);
  }
  std::optional<ContactReactions> solution = solve_contacts(equations);
  if (solution) solution->reactions = units.size * solution->reactions.cwiseProduct(units.scale);
  return solution;
}

void ContactProblem::refuse(double t, const Vector& q) const {
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

ContactProblem::Modes ContactProblem::modes(double t, const Vector& q, const Vector& v,
                                            ContactCandidates candidates) {
  for (;;) {
    set(candidates);
    ContactReactions solution;
    if (row_count_ > 0) {
      evaluate_accelerations(t, q, v);
      std::optional<ContactReactions> found =
          solve(free_, free_sizes_, known_limits(t, q, v), Sticking::rests);
      if (!found) refuse(t, q);
      solution = *std::move(found);
    }
    const Slides slides = that_slide(solution);
    if (!break_loose(slides, candidates)) return modes_of(solution, slides);
  }
}

/// The frictions that do not hold, in the directions of their accelerations; of those that hardly begin to
/// slide, against their reactions, which are known better.
Slides ContactProblem::that_slide(const ContactReactions& solution) const {
  constexpr double hardly = 1e-6;
  Slides slides;
  for (std::size_t i = 0; i < candidates_.frictions.size(); ++i) {
    const Rows& rows = rows_of_frictions_[i];
    const double slip = solution.slips[Index(i)];
    if (!(slip > contact_roundoff)) continue;
    const Vector reaction = solution.reactions.segment(rows.first, rows.size);
    const bool is_by_reaction = slip < hardly && reaction.norm() > 0;
    slides.emplace_back(
        candidates_.frictions[i],
        is_by_reaction ? Vector(-reaction) : Vector(solution.accelerations.segment(rows.first, rows.size)));
  }
  return slides;
}

/// Frictions that slide have their smaller coefficient from then on, with other reactions and directions.
/// @return  whether there is any that has not been loose before
bool ContactProblem::break_loose(const Slides& slides, ContactCandidates& candidates) const {
  bool any = false;
  for (const Slide& slide : slides) {
    const Friction& friction = *model_->constraints[slide.constraint].friction;
    if (friction.of_sticking() == friction.coefficient || contains(candidates.loose, slide.constraint)) {
      continue;
    }
    auto& all = candidates.loose;
    all.insert(std::upper_bound(all.begin(), all.end(), slide.constraint), slide.constraint);
    any = true;
  }
  return any;
}

ContactProblem::Modes ContactProblem::modes_of(const ContactReactions& solution, const Slides& slides) const {
  Modes modes{candidates_.bilateral, {}};
  for (Index i = 0; i < contacts(); ++i) {
    const bool presses = solution.reactions[i] > 0;
    const bool stays = std::abs(solution.accelerations[i]) <= contact_roundoff;
    if (presses || stays) modes.active.push_back(constraint(i));
  }
  std::sort(modes.active.begin(), modes.active.end());
  const ActiveSet holding = modes.active;
  const auto is_loaded = [&](std::size_t i) {
    const auto& contact = model_->constraints[i].friction->contact;
    return !contact || contains(holding, *contact);
  };
  for (const Slides* all : {&candidates_.sliding, &slides}) {
    for (const Slide& slide : *all) {
      if (is_loaded(slide.constraint)) modes.sliding.push_back(slide);
    }
  }
  for (const std::size_t friction : candidates_.frictions) {
    const bool slips = std::any_of(slides.begin(), slides.end(),
                                   [&](const Slide& slide) { return slide.constraint == friction; });
    if (is_loaded(friction) && !slips) modes.active.push_back(friction);
  }
  std::sort(modes.active.begin(), modes.active.end());
  std::sort(modes.sliding.begin(), modes.sliding.end(),
            [](const Slide& a, const Slide& b) { return a.constraint < b.constraint; });
  return modes;
}

double ContactProblem::acceleration_without(double t, const Vector& q, const Vector& v,
                                            ContactCandidates others, std::size_t contact) {
  const auto is_loaded_by_it = [&](std::size_t friction) {
    return model_->constraints[friction].friction->contact == contact;
  };
  const auto erase = [](auto& all, const auto& is_left_out) {
    all.erase(std::remove_if(all.begin(), all.end(), is_left_out), all.end());
  };
  erase(others.contacts, [&](std::size_t i) { return i == contact; });
  erase(others.frictions, is_loaded_by_it);
  erase(others.sliding, [&](const Slide& slide) { return is_loaded_by_it(slide.constraint); });
  set(others);
  evaluate_accelerations(t, q, v);
  Vector acceleration = motion_.acceleration();
  if (row_count_ > 0) {
    const auto solution = solve(free_, free_sizes_, known_limits(t, q, v), Sticking::rests);
    if (!solution && (frictions() > 0 || !others.sliding.empty())) {
      return acceleration_without(t, q, v, {others.bilateral, others.contacts, {}, {}}, contact);
    }
    if (!solution) refuse(t, q);
    acceleration += responses_ * solution->reactions;
  }
  ConstraintTerms terms;
  model_->constraints[contact].function->evaluate(t, q, v, motion_.terms().rate, terms);
  return terms.gradient.row(0).dot(acceleration) - terms.gamma[0];
}

/// One phase of an impulse: Newton's method, each step of which is a complementarity problem (Josephy). For
/// linear f and quadratic L the first step is the solution.
void ContactProblem::run(double t, const Vector& q, Phase& phase) {
  constexpr int most = 50;
  Vector bilateral_values;
  Matrix bilateral_rows;
  Vector change;
  Vector bilateral;
  const Vector start = phase.v;
  double step_before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < most; ++i) {
    interruption_point();
    motion_.evaluate_stage(t, q, phase.v);
    bilateral_.evaluate(t, q, phase.v, bilateral_values, bilateral_rows);
    evaluate_rows(t, q, phase.v);
    respond_to_rows();
    Vector force = phase.momentum - motion_.terms().momentum;
    force += directions_.leftCols(contacts()) * phase.least;
    if (!motion_.respond(force, -bilateral_values, change, bilateral)) throw NotFinite("the impulse");
    const Vector free = values_ + rows_ * change;
    const Vector sizes = rows_.cwiseAbs() * (phase.v.cwiseAbs() + change.cwiseAbs()) + values_.cwiseAbs();
    Vector limits = Vector::Zero(frictions());
    for (Index j = 0; j < frictions(); ++j) {
      const std::size_t friction = candidates_.frictions[std::size_t(j)];
      const Index contact = contact_of(friction);
      const double mu = model_->constraints[friction].friction->coefficient;
      if (contact >= 0) limits[j] = mu * phase.least[contact];
    }
    const auto solution = solve(free, sizes, limits, Sticking::struck);
    if (!solution) refuse(t, q);
    const Vector after = phase.v + change + responses_ * solution->reactions;
    const Vector weights = motion_.terms().mass.diagonal().cwiseMax(0).cwiseSqrt();
    const double step = (after - phase.v).cwiseProduct(weights).norm();
    const Vector terms = start.cwiseAbs() + after.cwiseAbs() + change.cwiseAbs() +
                         responses_.cwiseAbs() * solution->reactions.cwiseAbs();
    const double size = terms.cwiseProduct(weights).norm();
    phase.v = after;
    phase.reactions = solution->reactions;
    phase.reactions.head(contacts()) += phase.least;
    phase.bilateral = bilateral + multipliers_ * solution->reactions;
    if (step <= contact_roundoff * size || (step <= noise * size && !(step < step_before))) return;
    step_before = step;
  }
  throw ConstraintError(ConstraintError::Reason::no_velocity,
                        "no velocity after an impulse was found, at " + describe(*model_, t, q));
}

ContactProblem::Impulse ContactProblem::impulse(double t, const Vector& q, const Vector& v,
                                                const ContactCandidates& candidates,
                                                const std::vector<Bounce>& bounces) {
  set(candidates);
  MotionTerms terms;
  model_->equations->momentum(t, q, v, terms.momentum, terms.mass);
  Phase phase{terms.momentum, Vector::Zero(contacts()), v, {}, {}};
  run(t, q, phase);
  Vector reactions = phase.reactions;
  Vector bilateral = phase.bilateral;
  Vector returned = Vector::Zero(contacts());
  for (Index i = 0; i < contacts(); ++i) {
    const Bounce& bounce = bounces[std::size_t(i)];
    const double back = bounce.restitution * reactions[i];
    if (back * effect_(i, i) > bounce.least_speed) returned[i] = back;
  }
  if ((returned.array() > 0).any()) {
    model_->equations->momentum(t, q, phase.v, terms.momentum, terms.mass);
    phase.momentum = terms.momentum;
    phase.least = returned;
    run(t, q, phase);
    reactions += phase.reactions;
    bilateral += phase.bilateral;
  }
  Impulse impulse{phase.v, spread(*model_, candidates.bilateral, bilateral)};
  for (Index row = 0; row < contacts(); ++row) {
    impulse.multipliers[model_->multiplier_of(constraint(row))] = reactions[row];
  }
  for (const Rows& rows : rows_of_frictions_) {
    impulse.multipliers.segment(model_->multiplier_of(constraint(rows.first)), rows.size) =
        reactions.segment(rows.first, rows.size);
  }
  if (!(impulse.v.allFinite() && impulse.multipliers.allFinite())) throw NotFinite("the impulse");
  return impulse;
}

}  // namespace hybrid_sphere::mechanics
