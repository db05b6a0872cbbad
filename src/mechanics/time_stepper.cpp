#include "mechanics/time_stepper.hpp"

#include <algorithm>
#include <exception>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "interrupt/interrupt.hpp"
#include "mechanics/constraint_residual.hpp"
#include "mechanics/initial_positions.hpp"

namespace hybrid_sphere::mechanics {
namespace {

Stop stop_of(ConstraintError::Reason reason) {
  switch (reason) {
    case ConstraintError::Reason::singular: return Stop::singular;
    case ConstraintError::Reason::no_direction: return Stop::no_direction;
    case ConstraintError::Reason::inconsistent: return Stop::inconsistent;
    case ConstraintError::Reason::no_velocity: return Stop::no_velocity;
    case ConstraintError::Reason::painleve: return Stop::painleve;
  }
  return Stop::no_velocity;
}

Node node_of(const Vector& q, const Vector& v) {
  Node node{0, Vector(q.size() + v.size())};
  node.y << q, v;
  return node;
}

bool has_event(const std::vector<MonitoredGuard>& passed) {
  return std::any_of(passed.begin(), passed.end(),
                     [](const MonitoredGuard& guard) { return guard.kind == MonitoredGuard::Kind::event; });
}

/// Whether nothing has changed but gaps that have closed.
bool are_bounces(const Model& model, const std::vector<MonitoredGuard>& passed) {
  return std::all_of(passed.begin(), passed.end(), [&](const MonitoredGuard& guard) {
    return guard.kind == MonitoredGuard::Kind::position && model.constraints[guard.constraint].unilateral;
  });
}

constexpr std::size_t max_rounds_of_events = 100;  // at one instant; two or three occur in practice

}  // namespace

TimeStepper::TimeStepper(const Model& model, const Initial& initial, const Options& options,
                         const TimeDemand& demand)
    : model_(&model),
      options_(options),
      demand_(demand),
      now_(initial.time),
      lead_{initial.time, initial.q, initial.v},
      rules_(model, options.accuracy),
      integrator_(model, {options.accuracy, demand.horizon, options.max_step}, initial.q) {
  if (model.normalize) model.normalize(lead_.q);
  projection_ = {Vector::Zero(lead_.q.size()), Vector::Zero(lead_.v.size())};
  segments_.push_back({now_, {}, {}, {node_of(lead_.q, lead_.v)}});
}

/// What ends a motion becomes its status; what the monitor throws passes.
template <class Work>
std::optional<Status> TimeStepper::guarded(const Work& work) {
  std::exception_ptr thrown_by_monitor;
  const ShouldStop should_stop = [&] {
    try {
      return is_cancelled();
    } catch (...) {
      thrown_by_monitor = std::current_exception();
      return true;
    }
  };
  const InterruptScope scope(should_stop);
  try {
    return work();
  } catch (const Interrupted&) {
    if (thrown_by_monitor) std::rethrow_exception(thrown_by_monitor);
    return stopped(Stop::cancelled, "the monitor returned false");
  } catch (const ConstraintError& error) {
    return stopped(stop_of(error.reason()), error.what());
  } catch (const LivelockError& error) {
    return stopped(Stop::livelock, error.what());
  } catch (const NotFinite& error) {
    const bool is_undefined = dynamic_cast<const Undefined*>(&error) != nullptr;
    return stopped(is_undefined ? Stop::undefined : Stop::not_finite,
                   std::string(error.what()) + ", at " + describe(*model_, lead_.time, lead_.q, lead_.v));
  } catch (const StepError& error) {
    return stopped(Stop::no_step, "the integrator finds no step that is accurate enough (" +
                                      std::string(error.what()) + "), at " +
                                      describe(*model_, lead_.time, lead_.q, lead_.v));
  }
}

Status TimeStepper::start(const std::optional<ActiveSet>& active) {
  const auto begin = [&]() -> std::optional<Status> {
    Segment& first = segments_.back();
    if (options_.project_positions) project_positions(active);
    first.active = rules_.begin(lead_.time, lead_.q, lead_.v, integrator_.sizes(lead_.time, lead_.q, lead_.v),
                                look_ahead(), active);
    first.sliding = rules_.sliding();
    if (!first.active.empty()) require_constraints(first.active);
    first.nodes.back() = node_of(lead_.q, lead_.v);
    return std::nullopt;
  };
  return guarded(begin).value_or(Status{Stop::reached_end, now_, "the start"});
}

/// Moves the positions onto the holonomic constraints that hold from the start.
void TimeStepper::project_positions(const std::optional<ActiveSet>& active) {
  const ActiveSet holding = holonomic_at_start(*model_, lead_.time, lead_.q, active);
  if (holding.empty()) return;
  const double allowed = std::max(options_.accuracy, residual_roundoff);
  const Vector given = lead_.q;
  lead_.q = positions_on(*model_, holding, lead_.time, lead_.q, lead_.v, allowed);
  projection_.q = lead_.q - given;
}

/// Refuses an initial state that is off the constraints that hold by more than the accuracy, relative to the
/// scale of the motion. Puts the velocities onto these constraints.
void TimeStepper::require_constraints(const ActiveSet& holding) {
  const double allowed = std::max(options_.accuracy, residual_roundoff);
  Sizes sizes = integrator_.sizes(lead_.time, lead_.q, lead_.v);
  sizes.q = sizes.q.cwiseMax(projection_.q.cwiseAbs());  // positions that were moved have round-off of that
  for (const std::size_t i : holding) {
    const Constraint& constraint = model_->constraints[i];
    const double off = relative_position(constraint, lead_.time, lead_.q, lead_.v, sizes.q);
    if (off > allowed) {
      std::ostringstream message;
      message << "the initial position is off the constraint " << constraint.name
              << ", which holds from the start, by " << off << " of its terms; allowed: at most " << allowed
              << ", or Options::project_positions (" << describe(*model_, lead_.time, lead_.q) << ")";
      throw std::invalid_argument(message.str());
    }
    const double residual = relative_velocity(*model_, {i}, lead_.time, lead_.q, lead_.v, sizes.v);
    if (residual <= allowed || options_.project_initial) continue;
    std::ostringstream message;
    message << "the initial velocities violate the constraint " << constraint.name
            << ", which holds from the start: its residual relative to its terms is " << residual
            << "; allowed: at most " << allowed << ", or have them projected ("
            << describe(*model_, lead_.time, lead_.q, lead_.v) << ")";
    throw std::invalid_argument(message.str());
  }
  Impulse projected;
  ImpulseSolver(*model_).solve(holding, lead_.time, lead_.q, lead_.v, projected);
  projection_.v = projected.velocity - lead_.v;
  lead_.v = projected.velocity;
}

Status TimeStepper::advance(double until, const SwitchSink& on_switch) {
  counts_.steps_before = integrator_.effort().steps;
  counts_.switches_before = counts_.switches;
  for (;;) {
    tell(on_switch);
    std::optional<Status> status = guarded([&] { return go_on(until); });
    if (!status) continue;
    // A step that was taken before somebody cancelled may lead further.
    now_ = status->time = std::clamp(status->time, now_, until);
    tell(on_switch);
    if (!demand_.keeps_history) forget_before(now_);
    return *status;
  }
}

void TimeStepper::tell(const SwitchSink& on_switch) {
  while (!untold_.empty()) {
    const Switch next = std::move(untold_.front());
    untold_.pop_front();
    now_ = std::max(now_, next.time);
    if (on_switch) on_switch(next);
  }
}

/// @return  none where there are switches to tell
std::optional<Status> TimeStepper::go_on(double until) {
  for (;;) {
    const bool is_over = phase_ == Phase::changed || phase_ == Phase::ended;
    if (lead_.time > until || (lead_.time == until && !is_over))
      return Status{Stop::reached_end, until, "the requested end"};
    const std::optional<Status> status = is_over ? pass_end_of_segment() : take_step();
    if (status) return status;
    if (!untold_.empty()) return std::nullopt;
  }
}

std::optional<Status> TimeStepper::pass_end_of_segment() {
  const bool accumulated = std::exchange(phase_, Phase::ended) == Phase::changed && accumulates();
  if (accumulated || rules_.events_accumulate()) {
    return stopped(Stop::accumulation, "switches accumulate faster than max_switches allows, at " +
                                           describe(*model_, lead_.time, lead_.q));
  }
  switch_constraints();
  phase_ = Phase::to_begin;
  if (lead_.time >= demand_.end || counts_.switches - counts_.switches_before < options_.max_switches)
    return std::nullopt;
  return stopped(Stop::too_many_switches, std::to_string(options_.max_switches) + " switches, the limit");
}

/// How far the motion is looked at where velocities say nothing [s].
double TimeStepper::look_ahead() const {
  constexpr double fraction = 1e-3;
  if (integrator_.next_step() > 0) return integrator_.next_step();
  return fraction * std::min(demand_.horizon, demand_.end - lead_.time);
}

void TimeStepper::switch_constraints() {
  std::vector<Switch> changes;
  const Vector v_before = lead_.v;
  ActiveSetRules::Occasion occasion{look_ahead(), passed_, is_disturbed_};
  const auto sizes = [this] { return integrator_.sizes(lead_.time, lead_.q, lead_.v); };
  try {
    // An event's reset may change what holds, and the impulse of a constraint be an event.
    for (std::size_t round = 0;; ++round) {
      const bool occurs = rules_.pass_events(lead_.time, lead_.q, lead_.v, sizes(), occasion, changes);
      if (round > 0 && !occurs) break;
      if (round == max_rounds_of_events) {
        throw LivelockError("events follow one another endlessly, at " +
                            describe(*model_, lead_.time, lead_.q, lead_.v));
      }
      rules_.switch_constraints(lead_.time, lead_.q, lead_.v, sizes(), occasion, changes);
      occasion = {look_ahead(), {}, false};
    }
  } catch (...) {
    if (!changes.empty()) passed_.clear();
    keep(changes);
    throw;
  }
  // A slip that has ended may begin anew from 0, in another direction: no switch.
  if (changes.empty() && (is_disturbed_ || lead_.v != v_before)) push_segment();
  is_disturbed_ = false;
  passed_.clear();
  keep(changes);
}

void TimeStepper::keep(std::vector<Switch>& changes) {
  if (changes.empty()) return;
  for (Switch& change : changes) {
    change.index = counts_.switches++;
    untold_.push_back(std::move(change));
  }
  push_segment();
}

void TimeStepper::push_segment() {
  if (!demand_.keeps_history) segments_.clear();
  segments_.push_back({lead_.time, rules_.active(), rules_.sliding(), {node_of(lead_.q, lead_.v)}});
  segments_.back().nodes.back().error = integrator_.estimated_error();
}

void TimeStepper::begin_segment() {
  Segment& segment = segments_.back();
  until_ = std::min(demand_.end, rules_.next_instant(lead_.time));
  integrator_.begin(segment,
                    rules_.monitored(lead_.time, lead_.q, lead_.v,
                                     integrator_.sizes(lead_.time, lead_.q, lead_.v), look_ahead()),
                    until_ - segment.start);
  phase_ = Phase::goes_on;
}

std::optional<Status> TimeStepper::take_step() {
  if (integrator_.effort().steps - counts_.steps_before >= options_.max_steps) {
    return stopped(Stop::too_many_steps, "more than " + std::to_string(options_.max_steps) + " steps");
  }
  if (phase_ == Phase::to_begin) begin_segment();
  if (!demand_.keeps_history) before_last_step_ = integrator_.memory();
  try {
    if (integrator_.advance()) {
      phase_ = Phase::changed;
      passed_ = integrator_.passed();
    }
  } catch (...) {
    take_last();
    throw;
  }
  take_last();
  if (phase_ == Phase::goes_on && lead_.time >= until_) phase_ = Phase::ended;
  InterruptScope::count_from_here();
  if (is_cancelled()) return stopped(Stop::cancelled, "the monitor returned false");
  return std::nullopt;
}

void TimeStepper::take_last() {
  const Segment& segment = segments_.back();
  const Node& node = segment.nodes.back();
  lead_.time = node.x < until_ - segment.start ? std::min(segment.start + node.x, until_) : until_;
  lead_.q = node.y.head(lead_.q.size());
  lead_.v = node.y.tail(lead_.v.size());
}

void TimeStepper::forget_before(double time) {
  std::vector<Node>& nodes = segments_.back().nodes;
  const double x = time - segments_.back().start;
  const auto later = [](double at, const Node& node) { return at < node.x; };
  const auto next = std::upper_bound(nodes.begin(), nodes.end(), x, later);
  if (next != nodes.begin()) nodes.erase(nodes.begin(), next - 1);
}

bool TimeStepper::is_cancelled() const {
  if (!options_.monitor) return false;
  const Segment& segment = segments_.back();
  return !options_.monitor(
      {segment.start + segment.nodes.back().x, integrator_.effort().steps, counts_.switches});
}

// At the rate of the last instants the number of switches allowed would be used up in a thousandth of the
// time; or the clock cannot tell the last events apart. Bounces do not count: they end in contact, after a
// number of them that the resolution of positions and velocities bounds.
bool TimeStepper::accumulates() {
  constexpr std::size_t many = 1000;
  constexpr std::size_t few = 32;
  if (are_bounces(*model_, passed_)) return false;
  instants_.push_back(lead_.time);
  if (has_event(passed_) && instants_.size() > few) {
    const double before = instants_[instants_.size() - 1 - few];
    if (lead_.time - before <= segments_.back().resolution(0)) return true;
  }
  if (instants_.size() <= many) return false;
  const double span = lead_.time - instants_.front();
  instants_.pop_front();
  return span <= demand_.horizon / static_cast<double>(options_.max_switches);
}

TimeStepper::Memory TimeStepper::memory() const {
  const Segment& segment = segments_.back();
  ConstrainedMotion motion(*model_);
  motion.set_active(segment.active, segment.sliding);
  MotionStep step(motion);
  Node node = state_at(segment, std::min(now_ - segment.start, segment.duration()), step);
  node.x = 0;
  const bool is_within_step = now_ < lead_.time && before_last_step_;
  return {now_, std::move(node), rules_.memory(), is_within_step ? *before_last_step_ : integrator_.memory(),
          counts_.switches};
}

void TimeStepper::restore(const Memory& memory) {
  begin_again(memory);
  untold_.clear();
  instants_.clear();
}

void TimeStepper::begin_again(const Memory& memory) {
  now_ = lead_.time = memory.time;
  lead_.q = memory.node.y.head(lead_.q.size());
  lead_.v = memory.node.y.tail(lead_.v.size());
  rules_.restore(memory.rules);
  integrator_.restore(memory.integrator, memory.node);
  before_last_step_.reset();
  segments_.assign(1, {lead_.time, rules_.active(), rules_.sliding(), {memory.node}});
  counts_.switches = memory.switches;
  phase_ = Phase::ended;
  passed_.clear();
  is_disturbed_ = true;
}

}  // namespace hybrid_sphere::mechanics
