#include "mechanics/active_set_rules.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "hybrid_sphere/numerical_error.hpp"
#include "mechanics/constraint_residual.hpp"
#include "mechanics/decompositions/pivoted_qr.hpp"
#include "mechanics/guards.hpp"
#include "mechanics/make_switch.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::mechanics {

namespace {

/// Of the clock [s].
double resolution(double t) { return 16 * DBL_EPSILON * std::abs(t); }

}  // namespace

ActiveSetRules::ActiveSetRules(const Model& model, double accuracy)
    : model_(&model),
      impulse_(model),
      motion_(model),
      contacts_(model, accuracy),
      events_(model),
      looseness_(std::max(1.0, accuracy / DBL_EPSILON)),
      memory_{std::vector<bool>(model.constraints.size(), true),
              std::vector<bool>(model.constraints.size(), false),
              std::vector<double>(model.constraints.size(), -std::numeric_limits<double>::infinity()),
              {},
              {}} {}

ActiveSetRules::Memory ActiveSetRules::memory() const {
  Memory memory = memory_;
  memory.events = events_.sides();
  return memory;
}

void ActiveSetRules::restore(const Memory& memory) {
  memory_ = memory;
  events_.restore(memory.events);
}

ActiveSet ActiveSetRules::begin(double t, const Vector& q, const Vector& v, const Sizes& sizes, double ahead,
                                const std::optional<ActiveSet>& known) {
  memory_.active.clear();
  for (std::size_t i = 0; i < model_->constraints.size(); ++i) {
    const Schedule& schedule = model_->constraints[i].schedule;
    if (model_->constraints[i].unilateral) refuse_overlap(i, t, q, sizes.q);
    if (known) {
      const bool holds = contains(*known, i);
      memory_.positive[i] = holds || !schedule.guard;
      memory_.kept[i] = holds && schedule.guard;
      if (holds && in_interval(i, t) && is_bilateral(i)) memory_.active.push_back(i);
    } else if (model_->constraints[i].unilateral) {
      memory_.positive[i] = touches(i, t, q, v, sizes);
      memory_.kept[i] = memory_.positive[i];
    } else {
      const bool is_within = schedule.begin < t && t < schedule.end;
      const bool is_positive = !schedule.guard || sign_of(*schedule.guard, t, q, q.cwiseAbs()) > 0;
      memory_.kept[i] = is_within && schedule.guard && holds_on_edge(i, t, q, v, sizes, ahead);
      memory_.positive[i] = is_positive || memory_.kept[i];
      if (memory_.positive[i] && is_within && is_bilateral(i)) memory_.active.push_back(i);
    }
  }
  if (!contacts_.are_needed()) return memory_.active;
  const ContactRules::Decision decision =
      contacts_.begin({t, q, sizes.v, resolution(t)}, v, memory_.active, members(t, true), known);
  memory_.active = decision.active;
  memory_.sliding = decision.sliding;
  return memory_.active;
}

void ActiveSetRules::refuse_overlap(std::size_t i, double t, const Vector& q, const Vector& sizes) const {
  const Constraint& constraint = model_->constraints[i];
  if (sign_of(*constraint.schedule.guard, t, q, looseness_ * sizes) <= 0) return;
  const double gap = -constraint.schedule.guard->value(t, q);
  throw std::invalid_argument(
      text::refusal("the initial gap of constraint " + constraint.name + " = " + text::shortest(gap),
                    "a number >= 0") +
      " (" + describe(*model_, t, q) + ")");
}

/// Sizes of q' with which the rate of a guard counts as 0: by the accuracy of its own terms, or by the
/// round-off of the scale of the motion.
Vector ActiveSetRules::loose_rate(const Vector& q, const Vector& rate, const Sizes& sizes) const {
  return (looseness_ * rate.cwiseAbs()).cwiseMax(sizes_of_rate(*model_, q, sizes.v));
}

/// Whether a gap is 0, or less, and does not open.
bool ActiveSetRules::touches(std::size_t i, double t, const Vector& q, const Vector& v, const Sizes& sizes) {
  const Guard& overlap = *model_->constraints[i].schedule.guard;
  constexpr double roundings = 16;  // of a position that has been put onto the contact
  const int sign = sign_of(overlap, t, q, roundings * sizes.q);
  if (sign != 0) return sign > 0;
  Vector rate;
  model_->equations->rate(q, v, rate);
  return sign_of_rate(overlap, t, q, rate, loose_rate(q, rate, sizes)) >= 0;
}

/// Whether a constraint holds already on the edge of its guard, as the state of a motion on it does: the
/// velocities satisfy it, lead neither way, and without it would lead where it holds.
bool ActiveSetRules::holds_on_edge(std::size_t i, double t, const Vector& q, const Vector& v,
                                   const Sizes& sizes, double ahead) {
  const Guard& guard = *model_->constraints[i].schedule.guard;
  if (sign_of(guard, t, q, looseness_ * sizes.q) != 0) return false;
  Vector rate;
  model_->equations->rate(q, v, rate);
  if (sign_of_rate(guard, t, q, rate, loose_rate(q, rate, sizes)) != 0) return false;
  const double rounding = looseness_ * DBL_EPSILON;
  if (!(relative_velocity(*model_, {i}, t, q, v, sizes.v) <= rounding)) return false;
  Node start{0, Vector(q.size() + v.size())};
  start.y << q, v;
  motion_.set_active(memory_.active, memory_.sliding);
  MotionStep step(motion_);
  try {
    const Node there = step.reach(t, start, ahead);
    const Vector at = there.y.head(q.size());
    Vector later;
    model_->equations->rate(at, there.y.tail(v.size()), later);
    return guard.rate(t + ahead, at, later) > guard.rate(t, q, rate);
  } catch (const NumericalError&) {
    return false;  // the motion need not come so far
  }
}

/// The motion under the constraints that hold.
void ActiveSetRules::take_up_motion(double t, const Vector& q, const Vector& v) {
  motion_.set_active(memory_.active, memory_.sliding);
  motion_.aim(t, q, v);
}

bool ActiveSetRules::in_interval(std::size_t i, double t) const {
  const Schedule& schedule = model_->constraints[i].schedule;
  return schedule.begin <= t && t < schedule.end;
}

double ActiveSetRules::next_instant(double t) const {
  double next = std::numeric_limits<double>::infinity();
  for (const Constraint& constraint : model_->constraints) {
    for (const double instant : {constraint.schedule.begin, constraint.schedule.end}) {
      if (instant > t) next = std::min(next, instant);
    }
  }
  return next;
}

std::vector<MonitoredGuard> ActiveSetRules::monitored(double t, const Vector& q, const Vector& v,
                                                      const Sizes& sizes, double ahead) {
  std::vector<MonitoredGuard> guards;
  for (std::size_t i = 0; i < memory_.positive.size(); ++i) {
    const bool watch = model_->constraints[i].schedule.guard && in_interval(i, t);
    memory_.kept[i] = watch && is_kept(i, t, q, v, sizes);
    if (watch && !memory_.kept[i]) guards.push_back({i, memory_.positive[i]});
  }
  monitor_contacts(guards);
  if (model_->events.empty()) return guards;
  take_up_motion(t, q, v);
  events_.monitor({t, q, v, sizes, resolution(t), ahead}, motion_, guards);
  return guards;
}

void ActiveSetRules::monitor_contacts(std::vector<MonitoredGuard>& guards) const {
  using Kind = MonitoredGuard::Kind;
  for (const std::size_t i : memory_.active) {
    if (model_->constraints[i].unilateral) guards.push_back({i, true, Kind::reaction});
    if (model_->constraints[i].friction) guards.push_back({i, true, Kind::limit});
  }
  for (const Slide& slide : memory_.sliding) {
    guards.push_back({slide.constraint, true, Kind::slip});
  }
}

// Where a body has landed, or a rope is taut, the constraint itself keeps the motion on its guard's edge:
// dg/dt is 0 and, as a function of the velocities, a sum of the constraints' functions.
bool ActiveSetRules::is_kept(std::size_t i, double t, const Vector& q, const Vector& v, const Sizes& sizes) {
  constexpr double small = 1e-9;
  if (memory_.active.empty()) return false;
  const Guard& guard = *model_->constraints[i].schedule.guard;
  if (sign_of(guard, t, q, memory_.kept[i] ? Vector(looseness_ * sizes.q) : sizes.q) != 0) return false;
  Vector rate;
  model_->equations->rate(q, v, rate);
  if (sign_of_rate(guard, t, q, rate, loose_rate(q, rate, sizes)) != 0) return false;
  take_up_motion(t, q, v);
  motion_.evaluate_stage(t, q, v);
  const Matrix& gradient = motion_.gradient();
  const double at_rest = guard.rate(t, q, Vector::Zero(q.size()));
  Vector direction(v.size());
  for (Index j = 0; j < v.size(); ++j) {
    model_->equations->rate(q, Vector::Unit(v.size(), j), rate);
    direction[j] = guard.rate(t, q, rate) - at_rest;
  }
  // In the metric of M, which has no units.
  const Vector scale = motion_.terms().mass.diagonal().cwiseMax(DBL_MIN).cwiseSqrt().cwiseInverse();
  const Matrix rows = scale.asDiagonal() * gradient.transpose();
  const Vector wanted = scale.cwiseProduct(direction);
  const Vector rest = wanted - rows * PivotedQr(rows).solve(wanted);
  return rest.norm() <= small * wanted.norm();
}

bool ActiveSetRules::is_bilateral(std::size_t i) const {
  return !model_->constraints[i].unilateral && !model_->constraints[i].friction;
}

/// Bilateral constraints that hold at t by their intervals and guards, or unilateral ones that touch.
ActiveSet ActiveSetRules::members(double t, bool unilateral) const {
  ActiveSet set;
  for (std::size_t i = 0; i < memory_.positive.size(); ++i) {
    const bool is_member = unilateral ? model_->constraints[i].unilateral.has_value() : is_bilateral(i);
    if (is_member && memory_.positive[i] && in_interval(i, t)) set.push_back(i);
  }
  return set;
}

// On the edge the velocity says where the motion goes; where it says nothing, a short piece of the motion
// does. What stays on the edge stays as it was, unless it has just been seen to change; so does what comes
// back to it before the clock can tell.
void ActiveSetRules::see_sides(double t, const Vector& q, const Vector& v_before, const Vector& v,
                               const Sizes& sizes, const Occasion& occasion) {
  const auto has_changed = [&](std::size_t i) {
    const auto is_it = [i](const MonitoredGuard& guard) {
      return guard.kind == MonitoredGuard::Kind::position && guard.constraint == i;
    };
    return std::any_of(occasion.passed.begin(), occasion.passed.end(), is_it);
  };
  Vector rate;
  Vector rate_before;
  for (std::size_t i = 0; i < memory_.positive.size(); ++i) {
    const Guard* const guard = model_->constraints[i].schedule.guard.get();
    if (guard == nullptr || !in_interval(i, t)) continue;
    if (is_kept(i, t, q, v, sizes)) continue;
    int sign = sign_of(*guard, t, q, memory_.kept[i] ? Vector(looseness_ * sizes.q) : sizes.q);
    if (sign == 0) {
      model_->equations->rate(q, v, rate);
      model_->equations->rate(q, v_before, rate_before);
      const bool is_off_by_errors = memory_.kept[i] && !changes_rate(*guard, t, q, rate, rate_before);
      sign = sign_of_rate(*guard, t, q, rate, is_off_by_errors ? loose_rate(q, rate, sizes) : rate_before);
    }
    if (sign == 0) sign = sign_ahead(i, t, q, v, sizes.q, occasion.ahead);
    if (sign == 0 && has_changed(i)) sign = memory_.positive[i] ? -1 : 1;
    const bool is_released = memory_.positive[i] && sign < 0;
    if (is_released && memory_.released[i] < t && t - memory_.released[i] <= resolution(t)) continue;
    if (is_released) memory_.released[i] = t;
    if (sign != 0) memory_.positive[i] = sign > 0;
  }
}

int ActiveSetRules::sign_ahead(std::size_t i, double t, const Vector& q, const Vector& v, const Vector& sizes,
                               double ahead) {
  Node start{0, Vector(q.size() + v.size())};
  start.y << q, v;
  motion_.set_active(memory_.active, memory_.sliding);
  MotionStep step(motion_);
  const Guard& guard = *model_->constraints[i].schedule.guard;
  for (const double part : {1e-3, 1e-2, 1e-1}) {
    try {
      const Node there = step.reach(t, start, part * ahead);
      const int sign = sign_of(guard, t + part * ahead, there.y.head(q.size()), sizes);
      if (sign != 0) return sign;
    } catch (const NumericalError&) {
      return 0;  // The motion need not come so far; if it does, it will say what is wrong there.
    }
  }
  return 0;
}

/// Refuses constraints on positions that are applied where these are elsewhere.
void ActiveSetRules::require_positions(const ActiveSet& next, double t, const Vector& q, const Vector& v,
                                       const Vector& sizes) const {
  constexpr double much = 1000;  // errors of the motion
  for (const std::size_t i : next) {
    if (contains(memory_.active, i)) continue;
    const Constraint& constraint = model_->constraints[i];
    const double allowed = much * looseness_ * DBL_EPSILON;
    if (relative_position(constraint, t, q, v, sizes) <= allowed) continue;
    throw ConstraintError(ConstraintError::Reason::inconsistent,
                          "the constraint on positions " + constraint.name +
                              " is applied where they do not satisfy it, at " + describe(*model_, t, q));
  }
}

ContactRules::Decision ActiveSetRules::decide(double t, const Vector& q, const Vector& v, const Sizes& sizes,
                                              const Occasion& occasion, bool may_bounce) {
  const ActiveSet next = members(t, false);
  require_positions(next, t, q, v, sizes.q);
  if (contacts_.are_needed()) {
    return contacts_.decide({t, q, sizes.v, resolution(t), may_bounce, occasion.is_disturbed},
                            {v, memory_.active, memory_.sliding}, next, members(t, true), occasion.passed);
  }
  ContactRules::Decision decision{next, {}, next != memory_.active, v, {}, {}, 0};
  if (occasion.is_disturbed && !next.empty()) {
    const double allowed = std::max(residual_roundoff, looseness_ * DBL_EPSILON);
    decision.has_impulse =
        decision.has_impulse || relative_velocity(*model_, next, t, q, v, sizes.v) > allowed;
  } else if (!decision.has_impulse) {
    return decision;
  }
  Impulse impulse;
  impulse_.solve(next, t, q, v, impulse);
  decision.v = impulse.velocity;
  decision.multipliers = spread(*model_, next, impulse.multipliers);
  decision.impulse = impulse.impulse;
  decision.rank = impulse.rank;
  return decision;
}

bool ActiveSetRules::pass_events(double t, const Vector& q, Vector& v, const Sizes& sizes, Occasion& occasion,
                                 std::vector<Switch>& impulses) {
  if (model_->events.empty()) return false;
  take_up_motion(t, q, v);
  const EventRules::Instant at{t, q, v, sizes, resolution(t), occasion.ahead};
  const std::vector<std::size_t> events = events_.occurring(at, occasion.passed, motion_);
  if (events.empty()) return false;
  const bool has_reset = std::any_of(events.begin(), events.end(),
                                     [this](std::size_t i) { return bool(model_->events[i].reset); });
  Switch change = has_reset ? reset_by(events, at, occasion)
                            : make_switch(*model_, memory_.active,
                                          {memory_.active, memory_.sliding, false, v,
                                           Vector::Zero(model_->multipliers()), Vector::Zero(v.size()), 0},
                                          t, q, v);
  change.events = events;
  v = change.v_after;
  impulses.push_back(std::move(change));
  if (has_reset) {
    events_.rearm({t, q, v, sizes, resolution(t), occasion.ahead});
    occasion = {occasion.ahead, {}, false};
  }
  return true;
}

/// A reset, and the laws of impact for the velocities after it: a contact pushes and does not pull, a
/// friction stays within its limit.
Switch ActiveSetRules::reset_by(const std::vector<std::size_t>& events, const EventRules::Instant& at,
                                const Occasion& occasion) {
  const Vector v = events_.after_resets(events, at);
  see_sides(at.t, at.q, at.v, v, at.sizes, {at.ahead, {}, true});
  ContactRules::Decision decision = decide(at.t, at.q, v, at.sizes, {at.ahead, occasion.passed, true}, true);
  Vector p_before;
  Matrix mass;
  model_->equations->momentum(at.t, at.q, at.v, p_before, mass);
  model_->equations->momentum(at.t, at.q, decision.v, decision.impulse, mass);
  decision.impulse -= p_before;
  if (decision.multipliers.size() == 0) decision.multipliers = Vector::Zero(model_->multipliers());
  Switch change = make_switch(*model_, memory_.active, decision, at.t, at.q, at.v);
  keep(decision, at.t);
  return change;
}

void ActiveSetRules::keep(const ContactRules::Decision& decision, double t) {
  for (std::size_t i = 0; i < memory_.positive.size(); ++i) {
    if (!model_->constraints[i].unilateral || !memory_.positive[i]) continue;
    if (contains(decision.active, i)) continue;
    memory_.positive[i] = false;
    memory_.released[i] = t;
  }
  memory_.active = decision.active;
  memory_.sliding = decision.sliding;
}

/// Contacts that have parted at this instant count as closed again: an impulse at another one may drive them
/// together, and so on without end.
void ActiveSetRules::meet_again(double t) {
  for (std::size_t i = 0; i < memory_.positive.size(); ++i) {
    if (model_->constraints[i].unilateral && memory_.released[i] == t) memory_.positive[i] = true;
  }
}

void ActiveSetRules::switch_constraints(double t, const Vector& q, Vector& v, const Sizes& sizes,
                                        const Occasion& occasion, std::vector<Switch>& impulses) {
  // Bodies may meet again and again at one instant, as the ends of a rod do; then they do not bounce any
  // more, and all that have met do so at once.
  constexpr std::size_t most_bounces = 8;
  using Mode = std::pair<ActiveSet, Slides>;
  std::vector<Mode> seen;
  Vector v_before = v;
  for (std::size_t changes = 0;; ++changes) {
    const Occasion now = changes == 0 ? occasion : Occasion{occasion.ahead, {}, false};
    see_sides(t, q, v_before, v, sizes, now);
    const bool may_bounce = changes < most_bounces;
    if (!may_bounce) meet_again(t);
    const ContactRules::Decision next = decide(t, q, v, sizes, now, may_bounce);
    const bool is_same = next.active == memory_.active && next.sliding == memory_.sliding;
    if (is_same && !next.has_impulse) {
      keep(next, t);
      v = next.v;  // put onto the constraints by less than their round-off
      return;
    }
    const bool bounces = contacts_.are_needed() && next.has_impulse && may_bounce;
    const Mode mode(next.active, next.sliding);
    if (!bounces && std::find(seen.begin(), seen.end(), mode) != seen.end()) {
      const auto list = [this](const ActiveSet& set) { return set.empty() ? "none" : names(*model_, set); };
      throw LivelockError("the constraints that hold alternate endlessly between " + list(memory_.active) +
                          " and " + list(next.active) + ", at " + describe(*model_, t, q));
    }
    if (!bounces) seen.push_back(mode);
    impulses.push_back(make_switch(*model_, memory_.active, next, t, q, v));
    keep(next, t);
    v_before = v;
    v = next.v;
  }
}

}  // namespace hybrid_sphere::mechanics
