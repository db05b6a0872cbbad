#include "mechanics/contact_rules.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <utility>

#include "mechanics/constraint_residual.hpp"
#include "mechanics/guards.hpp"

namespace hybrid_sphere::mechanics {
namespace {

using Kind = MonitoredGuard::Kind;

constexpr double slip_roundoff = 16 * DBL_EPSILON;

const Slide* find(const Slides& sliding, std::size_t constraint) {
  const auto is_it = [&](const Slide& slide) { return slide.constraint == constraint; };
  const auto place = std::find_if(sliding.begin(), sliding.end(), is_it);
  return place == sliding.end() ? nullptr : &*place;
}

const MonitoredGuard* find(const std::vector<MonitoredGuard>& passed, std::size_t constraint, Kind kind) {
  const auto place = std::find_if(passed.begin(), passed.end(), [&](const MonitoredGuard& guard) {
    return guard.constraint == constraint && guard.kind == kind;
  });
  return place == passed.end() ? nullptr : &*place;
}

bool has_passed(const std::vector<MonitoredGuard>& passed, std::size_t constraint, Kind kind) {
  return find(passed, constraint, kind) != nullptr;
}

}  // namespace

ContactRules::ContactRules(const Model& model, double accuracy)
    : model_(&model),
      problem_(model),
      contact_impulse_(model),
      impulse_(model),
      accuracy_(accuracy),
      looseness_(std::max(1e-12, 1e-3 * accuracy)) {
  for (const Constraint& constraint : model.constraints) {
    are_needed_ = are_needed_ || constraint.unilateral || constraint.friction;
  }
}

/// The change of f by the rounding of the velocities.
Vector ContactRules::rounding_of_rate(const Matrix& gradient, const Instant& at, const Vector& v,
                                      const Vector& v_before) const {
  const Vector speeds = v.cwiseAbs().cwiseMax(v_before.cwiseAbs());
  return gradient.cwiseAbs() * (looseness_ * speeds + slip_roundoff * at.speeds);
}

/// The sign of f of a constraint of one function; 0 where it can be due to rounding of the velocities.
int ContactRules::sign_of_rate(std::size_t constraint, const Instant& at, const Vector& v,
                               const Vector& v_before) const {
  Vector value;
  Matrix gradient;
  model_->constraints[constraint].function->evaluate(at.t, at.q, v, value, gradient);
  if (std::abs(value[0]) <= rounding_of_rate(gradient, at, v, v_before)[0]) return 0;
  return value[0] > 0 ? 1 : -1;
}

/// Constraints with friction that can react now.
std::vector<std::size_t> ContactRules::loaded(const Instant& at, const ActiveSet& touching) const {
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < model_->constraints.size(); ++i) {
    const Constraint& constraint = model_->constraints[i];
    if (!constraint.friction || !(constraint.schedule.begin <= at.t && at.t < constraint.schedule.end))
      continue;
    if (!constraint.friction->contact || contains(touching, *constraint.friction->contact)) all.push_back(i);
  }
  return all;
}

/// Whether bodies that touch approach each other by more than rounding; those that have touched before are
/// off by the errors of the motion, too.
bool ContactRules::meet(const Instant& at, const Before& before, const ActiveSet& touching) const {
  Vector value;
  Matrix gradient;
  return std::any_of(touching.begin(), touching.end(), [&](std::size_t contact) {
    if (contains(before.active, contact)) return sign_of_rate(contact, at, before.v, before.v) < 0;
    model_->constraints[contact].function->evaluate(at.t, at.q, before.v, value, gradient);
    return value[0] < -slip_roundoff * gradient.row(0).cwiseAbs().dot(at.speeds);
  });
}

/// The speed below which a bounce is not resolved: the height that the body loses by the next bounce is
/// round-off of the gap, the flight is shorter than the resolution of the clock, or the speed is round-off.
/// An instant that is late by the round-off of the gap gives as much height as a bounce of this speed loses:
/// slower bounces need not end.
double ContactRules::least_bounce_speed(const Instant& at, const Vector& v,
                                        const ContactCandidates& candidates, std::size_t contact) {
  const Constraint& constraint = model_->constraints[contact];
  const double e = constraint.unilateral->restitution;
  const double kept = e < 1 ? e : 0;  // without a loss the bounces do not come closer to each other
  // Another contact may hold the body up at the same place, which takes no part in the bounce, either.
  const ContactCandidates alone{candidates.bilateral, {contact}, {}, {}};
  const double back = std::max({0.0, -problem_.acceleration_without(at.t, at.q, v, candidates, contact),
                                -problem_.acceleration_without(at.t, at.q, v, alone, contact)});
  const double height = rounding_of(*constraint.schedule.guard, at.t, at.q, at.q.cwiseAbs());
  Vector value;
  Matrix gradient;
  constraint.function->evaluate(at.t, at.q, v, value, gradient);
  const double speed = slip_roundoff * gradient.row(0).cwiseAbs().dot(at.speeds);
  return std::max({std::sqrt(2 * back * height / (1 - kept * kept)), back * at.resolution / 2, speed});
}

/// All that touch, with the frictions that slip at v and those that do not.
ContactCandidates ContactRules::candidates_at(const Instant& at, const Vector& v, const ActiveSet& bilateral,
                                              const ActiveSet& touching) const {
  ContactCandidates candidates{bilateral, touching, {}, {}};
  for (const std::size_t friction : loaded(at, touching)) {
    const std::optional<Slide> slip = slip_of(friction, at, v, v);
    if (slip) {
      candidates.sliding.push_back(*slip);
    } else {
      candidates.frictions.push_back(friction);
    }
  }
  return candidates;
}

/// Whether bodies that touch part, by more than round-off and to a hop that is resolved.
bool ContactRules::parts(std::size_t contact, const Instant& at, const Vector& v, const Vector& v_before,
                         const ActiveSet& bilateral, const ActiveSet& touching) {
  if (sign_of_rate(contact, at, v, v_before) <= 0) return false;
  Vector value;
  Matrix gradient;
  model_->constraints[contact].function->evaluate(at.t, at.q, v, value, gradient);
  return value[0] > least_bounce_speed(at, v, candidates_at(at, v, bilateral, touching), contact);
}

/// Restitution of each contact that touches, and the bounces that are none.
std::vector<ContactImpulse::Bounce> ContactRules::bounces(const Instant& at, const Vector& v,
                                                          const ContactCandidates& candidates) {
  std::vector<ContactImpulse::Bounce> all;
  for (const std::size_t contact : candidates.contacts) {
    const double restitution = model_->constraints[contact].unilateral->restitution;
    ContactImpulse::Bounce bounce;
    if (at.may_bounce && restitution > 0)
      bounce = {restitution, least_bounce_speed(at, v, candidates, contact)};
    all.push_back(bounce);
  }
  return all;
}

void ContactRules::apply_impulse(const Instant& at, const Before& before, const ActiveSet& bilateral,
                                 const ActiveSet& touching, Decision& decision) {
  decision.has_impulse = true;
  if (touching.empty()) {
    Impulse impulse;
    impulse_.solve(bilateral, at.t, at.q, before.v, impulse);
    decision.v = impulse.velocity;
    decision.multipliers = spread(*model_, bilateral, impulse.multipliers);
    return;
  }
  ContactCandidates candidates{bilateral, touching, {}, {}};
  const std::vector<ContactImpulse::Bounce> all =
      bounces(at, before.v, candidates_at(at, before.v, bilateral, touching));
  for (const std::size_t friction : loaded(at, touching)) {
    if (model_->constraints[friction].friction->contact) candidates.frictions.push_back(friction);
  }
  ContactImpulse::Outcome impulse = contact_impulse_.solve(at.t, at.q, before.v, candidates, all);
  decision.has_impulse = impulse.v != before.v;  // what approaches by rounding is at rest
  decision.v = std::move(impulse.v);
  decision.multipliers = std::move(impulse.multipliers);
}

/// The slip of a friction; none where it can be due to rounding of the velocities.
/// @param error  of the motion, relative to the speeds: a slip within it is none, either
/// @param slow   nor one as slow as this
std::optional<Slide> ContactRules::slip_of(std::size_t friction, const Instant& at, const Vector& v,
                                           const Vector& v_before, double error, double slow) const {
  Vector value;
  Matrix gradient;
  model_->constraints[friction].function->evaluate(at.t, at.q, v, value, gradient);
  const Vector rounding =
      rounding_of_rate(gradient, at, v, v_before) + error * (gradient.cwiseAbs() * at.speeds);
  if ((value.array().abs() <= rounding.array() + slow).all()) return std::nullopt;
  return Slide(friction, value);
}

/// Whether a change of the velocities is as small as the slip that it takes away. It is not where the
/// constraints leave that slip nearly no motion: then the slip is small because of them, and not because it
/// ends.
bool ContactRules::is_as_small_as_slip(const Vector& change, std::size_t friction, const Instant& at,
                                       double slow) const {
  constexpr double many = 100;  // times: velocities may have masses that differ so much
  Vector value;
  Matrix gradient;
  model_->constraints[friction].function->evaluate(at.t, at.q, change, value, gradient);
  const Vector slip = accuracy_ * (gradient.cwiseAbs() * at.speeds);
  return ((gradient.cwiseAbs() * change.cwiseAbs()).array() <= many * (slip.array() + slow)).all();
}

/// In order, with the speeds below which their directions are not known.
void ContactRules::complete(Slides& slides, const Instant& at, const Vector& v,
                            const Vector& v_before) const {
  Vector value;
  Matrix gradient;
  for (Slide& slide : slides) {
    model_->constraints[slide.constraint].function->evaluate(at.t, at.q, v, value, gradient);
    slide.slowest = rounding_of_rate(gradient, at, v, v_before).norm();
  }
  std::sort(slides.begin(), slides.end(),
            [](const Slide& a, const Slide& b) { return a.constraint < b.constraint; });
}

/// Contacts that close, without those that open again by themselves before their overlap is more than the
/// round-off of the gap.
ActiveSet ContactRules::that_stay(const Instant& at, const Before& before, const ActiveSet& bilateral,
                                  const ActiveSet& touching) {
  ActiveSet stay;
  Vector value;
  Matrix gradient;
  for (const std::size_t contact : touching) {
    model_->constraints[contact].function->evaluate(at.t, at.q, before.v, value, gradient);
    const double speed = -value[0];
    const bool is_slow = speed > 0 && speed <= accuracy_ * gradient.row(0).cwiseAbs().dot(at.speeds);
    bool opens = false;
    if (is_slow && !contains(before.active, contact)) {
      const ContactCandidates candidates = candidates_at(at, before.v, bilateral, touching);
      const double back = problem_.acceleration_without(at.t, at.q, before.v, candidates, contact);
      const Guard& gap = *model_->constraints[contact].schedule.guard;
      opens = speed * speed <= 2 * back * rounding_of(gap, at.t, at.q, at.q.cwiseAbs());
    }
    if (!opens) stay.push_back(contact);
  }
  return stay;
}

ContactRules::Decision ContactRules::decide(const Instant& at, const Before& before,
                                            const ActiveSet& bilateral, const ActiveSet& all_touching,
                                            const std::vector<MonitoredGuard>& passed) {
  const ActiveSet touching = that_stay(at, before, bilateral, all_touching);
  Decision decision{{}, {}, false, before.v, Vector::Zero(model_->multipliers()), {}, 0};
  ActiveSet bilateral_before;
  for (const std::size_t i : before.active) {
    if (!model_->constraints[i].unilateral && !model_->constraints[i].friction) bilateral_before.push_back(i);
  }
  const bool is_applied =
      !std::includes(bilateral_before.begin(), bilateral_before.end(), bilateral.begin(), bilateral.end());
  const bool is_off = at.is_disturbed && !bilateral.empty() &&
                      relative_velocity(*model_, bilateral, at.t, at.q, before.v, at.speeds) > looseness_;
  if (is_applied || is_off || meet(at, before, touching))
    apply_impulse(at, before, bilateral, touching, decision);

  ContactCandidates candidates{bilateral, {}, {}, {}};
  for (const std::size_t contact : touching) {
    const bool may_part = decision.has_impulse || at.is_disturbed;
    const bool has_left = has_passed(passed, contact, Kind::reaction) ||
                          (may_part && parts(contact, at, decision.v, before.v, bilateral, touching));
    if (!has_left) candidates.contacts.push_back(contact);
  }
  // When the slip of one friction ends, others may end at the same instant, within the error of the motion.
  const bool slips_end = std::any_of(passed.begin(), passed.end(),
                                     [](const MonitoredGuard& guard) { return guard.kind == Kind::slip; });
  ActiveSet slipping;
  for (const std::size_t friction : loaded(at, candidates.contacts)) {
    const Slide* const slide = find(before.sliding, friction);
    const bool goes_on =
        !decision.has_impulse && !at.is_disturbed && !has_passed(passed, friction, Kind::slip);
    const bool may_end = slips_end && slide != nullptr;
    const MonitoredGuard* const ended = find(passed, friction, Kind::slip);
    const std::optional<Slide> slip = slip_of(friction, at, decision.v, before.v, may_end ? accuracy_ : 0,
                                              ended != nullptr ? ended->rounding : 0);
    if (has_passed(passed, friction, Kind::limit) && !decision.has_impulse) {
      candidates.frictions.push_back(friction);
      candidates.loose.push_back(friction);
    } else if (goes_on && slide != nullptr && !slip && !slips_end) {
      candidates.sliding.push_back(*slide);
    } else if (slip && !(goes_on && contains(before.active, friction))) {
      candidates.sliding.push_back(*slip);
      slipping.push_back(friction);
    } else {
      candidates.frictions.push_back(friction);
    }
  }
  do {
    decide_modes(at, before, passed, candidates, decision);
  } while (stop(slipping, at, before, decision, candidates));
  return decision;
}

void ContactRules::decide_modes(const Instant& at, const Before& before,
                                const std::vector<MonitoredGuard>& passed,
                                const ContactCandidates& candidates, Decision& decision) {
  ContactProblem::Modes modes = problem_.modes(at.t, at.q, decision.v, candidates);
  decision.active = std::move(modes.active);
  decision.sliding = std::move(modes.sliding);
  complete(decision.sliding, at, decision.v, before.v);
  const bool slips_end = std::any_of(passed.begin(), passed.end(),
                                     [](const MonitoredGuard& guard) { return guard.kind == Kind::slip; });
  if (decision.has_impulse || at.is_disturbed || slips_end || decision.active != before.active ||
      decision.sliding != before.sliding) {
    finish(at, before, passed, decision);
  }
}

/// A slip may be gone once the velocities are on the constraints that hold: a bounce so slow that it is none
/// leaves one. Such a friction may stick. @return  whether there are any
bool ContactRules::stop(ActiveSet& slipping, const Instant& at, const Before& before,
                        const Decision& decision, ContactCandidates& candidates) const {
  const auto has_slip = [&](std::size_t friction) {
    return slip_of(friction, at, decision.v, before.v).has_value();
  };
  const auto first = std::stable_partition(slipping.begin(), slipping.end(), has_slip);
  const ActiveSet ended(first, slipping.end());
  slipping.erase(first, slipping.end());
  for (const std::size_t friction : ended) {
    auto& sliding = candidates.sliding;
    sliding.erase(std::find_if(sliding.begin(), sliding.end(),
                               [&](const Slide& slide) { return slide.constraint == friction; }));
    auto& all = candidates.frictions;
    all.insert(std::upper_bound(all.begin(), all.end(), friction), friction);
  }
  return !ended.empty();
}

/// Puts the velocities onto the constraints that hold, off which they are by rounding; and slips that have
/// ended and turn to 0, off which they are by a part of the error of the motion.
void ContactRules::finish(const Instant& at, const Before& before, const std::vector<MonitoredGuard>& passed,
                          Decision& decision) {
  Impulse onto;
  impulse_.solve(decision.active, at.t, at.q, decision.v, onto);
  decision.v = onto.velocity;
  decision.rank = onto.rank;
  ActiveSet at_rest = decision.active;
  for (const Slide& slide : decision.sliding) {
    const MonitoredGuard* const ended = find(passed, slide.constraint, Kind::slip);
    if (slide.direction != 0 || ended == nullptr) continue;
    if (slip_of(slide.constraint, at, decision.v, before.v, accuracy_, ended->rounding)) continue;
    ActiveSet more = at_rest;
    more.insert(std::upper_bound(more.begin(), more.end(), slide.constraint), slide.constraint);
    try {
      impulse_.solve(more, at.t, at.q, decision.v, onto);
    } catch (const ConstraintError&) {
      continue;  // the others leave it no motion
    }
    if (!is_as_small_as_slip(onto.velocity - decision.v, slide.constraint, at, ended->rounding)) continue;
    decision.v = onto.velocity;
    at_rest = std::move(more);
  }
  Vector p_before;
  Matrix mass;
  model_->equations->momentum(at.t, at.q, before.v, p_before, mass);
  model_->equations->momentum(at.t, at.q, decision.v, decision.impulse, mass);
  decision.impulse -= p_before;
}

ContactRules::Decision ContactRules::begin(const Instant& at, const Vector& v, const ActiveSet& bilateral,
                                           const ActiveSet& touching, const std::optional<ActiveSet>& known) {
  ContactCandidates candidates{bilateral, {}, {}, {}};
  for (const std::size_t contact : touching) {
    if (known || sign_of_rate(contact, at, v, v) == 0) candidates.contacts.push_back(contact);
  }
  Decision decision{{}, {}, false, v, Vector::Zero(model_->multipliers()), {}, 0};
  for (const std::size_t friction : loaded(at, candidates.contacts)) {
    const std::optional<Slide> slip = slip_of(friction, at, v, v);
    if (slip && !(known && contains(*known, friction))) {
      candidates.sliding.push_back(*slip);
    } else {
      candidates.frictions.push_back(friction);
      const bool is_at_limit = known && !contains(*known, friction);
      if (is_at_limit) candidates.loose.push_back(friction);
    }
  }
  if (known) {
    for (const std::size_t i : *known) {
      const Schedule& schedule = model_->constraints[i].schedule;
      if (schedule.begin <= at.t && at.t < schedule.end) decision.active.push_back(i);
    }
    decision.sliding =
        candidates.loose.empty() ? candidates.sliding : problem_.modes(at.t, at.q, v, candidates).sliding;
  } else {
    ContactProblem::Modes modes = problem_.modes(at.t, at.q, v, candidates);
    decision.active = std::move(modes.active);
    decision.sliding = std::move(modes.sliding);
  }
  complete(decision.sliding, at, v, v);
  return decision;
}

}  // namespace hybrid_sphere::mechanics
