#include "mechanics/contact_problem.hpp"

#include <algorithm>
#include <cmath>

#include "mechanics/sliding_friction.hpp"

namespace hybrid_sphere::mechanics {

ContactProblem::ContactProblem(const Model& model) : model_(&model), rows_(model), motion_(model) {}

void ContactProblem::evaluate_accelerations(double t, const Vector& q, const Vector& v) {
  const ContactCandidates& candidates = rows_.candidates();
  Slides known;
  for (const Slide& slide : candidates.sliding) {
    if (!model_->constraints[slide.constraint].friction->contact) known.push_back(slide);
  }
  rows_.motion().set_active(candidates.bilateral, known);
  rows_.motion().evaluate_stage(t, q, v);
  rows_.evaluate(t, q, v);
  const Vector acceleration = rows_.motion().acceleration();
  free_ = rows_.gradient() * acceleration - rows_.gamma();
  free_sizes_ = rows_.gradient().cwiseAbs() * acceleration.cwiseAbs() + rows_.gamma().cwiseAbs();
  rows_.add_sliding_friction(t, q, v);
  rows_.respond();
}

/// The coefficient of a friction that does not slip: of sticking, unless it has broken loose. Its reaction is
/// then at its limit, where rounding would decide: it cannot hold any more.
double ContactProblem::coefficient(std::size_t friction) const {
  constexpr double hold = 1 - 1e-9;  // above the rounding of reactions, of which this leaves slips six digits
  const Friction& law = *model_->constraints[friction].friction;
  if (!contains(rows_.candidates().loose, friction)) return law.of_sticking();
  return std::min(law.coefficient, hold * law.of_sticking());
}

std::optional<ContactReactions> ContactProblem::solve(double t, const Vector& q, const Vector& v) {
  const ActiveSet& frictions = rows_.candidates().frictions;
  Vector coefficients(rows_.frictions());
  Vector limits = Vector::Zero(rows_.frictions());
  for (Index i = 0; i < rows_.frictions(); ++i) {
    const std::size_t constraint = frictions[std::size_t(i)];
    const Friction& friction = *model_->constraints[constraint].friction;
    coefficients[i] = coefficient(constraint);
    if (!friction.contact) limits[i] = coefficients[i] * load_of(*model_, friction, t, q, v, Vector());
  }
  return rows_.solve(free_, free_sizes_, coefficients, limits);
}

ContactProblem::Modes ContactProblem::modes(double t, const Vector& q, const Vector& v,
                                            ContactCandidates candidates) {
  const ActiveSet at_limit = candidates.loose;
  for (;;) {
    rows_.set(candidates);
    ContactReactions solution;
    if (rows_.size() > 0) {
      evaluate_accelerations(t, q, v);
      std::optional<ContactReactions> found = solve(t, q, v);
      if (!found) rows_.refuse(t, q);
      solution = *std::move(found);
    }
    const Slides slides = that_slide(solution);
    Modes modes = modes_of(solution, slides);
    Slides doubtful = slides;
    doubtful.erase(std::remove_if(doubtful.begin(), doubtful.end(),
                                  [&](const Slide& slide) { return contains(at_limit, slide.constraint); }),
                   doubtful.end());
    if (hold(doubtful, modes, t, q, v, candidates)) continue;
    if (!break_loose(slides, candidates)) return modes;
  }
}

/// The frictions that do not hold, in the directions of their accelerations; of those that hardly begin to
/// slide, against their reactions, which are known better.
Slides ContactProblem::that_slide(const ContactReactions& solution) const {
  constexpr double hardly = 1e-6;
  Slides slides;
  const ActiveSet& frictions = rows_.candidates().frictions;
  for (std::size_t i = 0; i < frictions.size(); ++i) {
    const ContactRows::Rows& rows = rows_.rows_of(i);
    const double slip = solution.slips[Index(i)];
    if (!(slip > contact_roundoff)) continue;
    const Vector reaction = solution.reactions.segment(rows.first, rows.size);
    const bool is_by_reaction = slip < hardly && reaction.norm() > 0;
    slides.emplace_back(frictions[i], is_by_reaction
                                          ? Vector(-reaction)
                                          : Vector(solution.accelerations.segment(rows.first, rows.size)));
  }
  return slides;
}

/// Several contacts can share one load in many ways, and the solution is only one of them: it may leave a
/// friction too little load to hold. The motion shares the load by least squares. A friction that would begin
/// to slide by the solution, but is held by the motion's share, holds.
/// @return  whether there is any
bool ContactProblem::hold(const Slides& slides, const Modes& modes, double t, const Vector& q,
                          const Vector& v, ContactCandidates& candidates) {
  if (slides.empty()) return false;
  motion_.set_active(modes.active, modes.sliding);
  motion_.evaluate_stage(t, q, v);
  const Vector& acceleration = motion_.acceleration();
  const auto erase = [](ActiveSet& set, std::size_t i) {
    set.erase(std::remove(set.begin(), set.end(), i), set.end());
  };
  ConstraintTerms terms;
  bool any = false;
  for (const Slide& slide : slides) {
    const auto& contact = model_->constraints[slide.constraint].friction->contact;
    if (contact && !contains(modes.active, *contact)) continue;
    model_->constraints[slide.constraint].function->evaluate(t, q, v, motion_.terms().rate, terms);
    const Vector slip = terms.gradient * acceleration - terms.gamma;
    const Vector sizes = terms.gradient.cwiseAbs() * acceleration.cwiseAbs() + terms.gamma.cwiseAbs();
    if (slip.dot(slide.heading.head(slip.size())) > contact_roundoff * sizes.norm()) continue;
    erase(candidates.frictions, slide.constraint);
    erase(candidates.loose, slide.constraint);
    auto& all = candidates.bilateral;
    all.insert(std::upper_bound(all.begin(), all.end(), slide.constraint), slide.constraint);
    any = true;
  }
  return any;
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
  const ContactCandidates& candidates = rows_.candidates();
  ActiveSet closed;
  for (Index i = 0; i < rows_.contacts(); ++i) {
    const bool presses = solution.reactions[i] > 0;
    const bool stays = std::abs(solution.accelerations[i]) <= contact_roundoff;
    if (presses || stays) closed.push_back(candidates.contacts[std::size_t(i)]);
  }
  const auto may_react = [&](std::size_t i) {
    const auto& friction = model_->constraints[i].friction;
    return !friction || !friction->contact || contains(closed, *friction->contact);
  };
  Modes modes{closed, {}};
  for (const Slides* all : {&candidates.sliding, &slides}) {
    for (const Slide& slide : *all) {
      if (may_react(slide.constraint)) modes.sliding.push_back(slide);
    }
  }
  for (const ActiveSet* all : {&candidates.bilateral, &candidates.frictions}) {
    for (const std::size_t i : *all) {
      const bool slips = std::any_of(slides.begin(), slides.end(),
                                     [&](const Slide& slide) { return slide.constraint == i; });
      if (may_react(i) && !slips) modes.active.push_back(i);
    }
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
  rows_.set(others);
  evaluate_accelerations(t, q, v);
  Vector acceleration = rows_.motion().acceleration();
  if (rows_.size() > 0) {
    const std::optional<ContactReactions> solution = solve(t, q, v);
    if (!solution && (rows_.frictions() > 0 || !others.sliding.empty())) {
      return acceleration_without(t, q, v, {others.bilateral, others.contacts, {}, {}}, contact);
    }
    if (!solution) rows_.refuse(t, q);
    acceleration += rows_.responses() * solution->reactions;
  }
  ConstraintTerms terms;
  model_->constraints[contact].function->evaluate(t, q, v, rows_.motion().terms().rate, terms);
  return terms.gradient.row(0).dot(acceleration) - terms.gamma[0];
}

}  // namespace hybrid_sphere::mechanics
