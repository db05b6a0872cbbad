#include "hybrid_sphere/mechanics/solve.hpp"

#include <cmath>
#include <deque>
#include <exception>
#include <sstream>
#include <stdexcept>

#include "interrupt/interrupt.hpp"
#include "mechanics/active_set_rules.hpp"
#include "mechanics/record.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::mechanics {
namespace {

[[noreturn]] void refuse(const std::string& what, double value, const std::string& allowed) {
  throw std::invalid_argument(text::refusal(what + " = " + text::shortest(value), allowed));
}

void check_size(const char* what, Index size, Index wanted) {
  if (size != wanted) {
    throw std::invalid_argument(std::string(what) + " has " + std::to_string(size) +
                                " components; the model has " + std::to_string(wanted));
  }
}

void check_finite(const std::vector<std::string>& names, const Vector& values) {
  for (Index i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) refuse(names[std::size_t(i)], values[i], "a finite number");
  }
}

void check(const Model& model, const Initial& initial, double duration, const Options& options) {
  check(model);
  check_size("q", initial.q.size(), model.equations->coordinates());
  check_size("v", initial.v.size(), model.equations->velocities());
  check_finite(model.coordinates, initial.q);
  check_finite(model.velocities, initial.v);
  if (!std::isfinite(initial.time)) refuse("t", initial.time, "a finite number");
  constexpr double least_time = 1e-100;  // below, squares underflow
  if (!(duration == 0 || (duration >= least_time && std::isfinite(duration)))) {
    refuse("duration", duration, "0, or a number >= 1e-100");
  }
  if (duration > 0 && initial.time + duration == initial.time) {
    refuse("duration", duration, "more than the rounding of the initial time");
  }
  if (!(options.accuracy >= least_accuracy && options.accuracy <= greatest_accuracy)) {
    refuse("accuracy", options.accuracy,
           text::shortest(least_accuracy) + " to " + text::shortest(greatest_accuracy));
  }
  if (!(options.max_step >= least_time)) {
    refuse("max_step", options.max_step, "a number >= 1e-100");
  }
}

Stop stop_of(ConstraintError::Reason reason) {
  switch (reason) {
    case ConstraintError::Reason::singular: return Stop::singular;
    case ConstraintError::Reason::no_direction: return Stop::no_direction;
    case ConstraintError::Reason::inconsistent: return Stop::inconsistent;
    case ConstraintError::Reason::no_velocity: return Stop::no_velocity;
  }
  return Stop::no_velocity;
}

/// One call of solve.
class Run {
 public:
  Run(Solution::Record& record, const Initial& initial, double duration, const Options& options)
      : record_(&record),
        options_(options),
        begin_(initial.time),
        end_(initial.time + duration),
        now_(initial.time),
        q_(initial.q),
        v_(initial.v),
        rules_(record.model, options.accuracy),
        integrator_(record.model, {options.accuracy, duration, options.max_step}, initial.q) {}

  /// Throws std::invalid_argument where the initial velocities are off a constraint.
  void go();
  Effort effort() const { return integrator_.effort(); }

 private:
  void begin();
  void require_constraints(const ActiveSet& holding);
  void switch_constraints();
  bool advance();
  bool is_cancelled() const;
  bool accumulates(bool changed);
  void stop(Stop why, const std::string& message);
  void stop_cancelled();
  void stop_not_finite(const NotFinite& error);

  Solution::Record* record_;
  Options options_;
  double begin_;
  double end_;
  double now_;
  Vector q_;
  Vector v_;
  ActiveSetRules rules_;
  SegmentIntegrator integrator_;
  std::deque<double> instants_;  // at which a guard changed, the last many [s]
};

void Run::stop(Stop why, const std::string& message) { record_->status = {why, now_, message}; }

void Run::stop_cancelled() { stop(Stop::cancelled, "the monitor returned false"); }

void Run::stop_not_finite(const NotFinite& error) {
  stop(Stop::not_finite, std::string(error.what()) + ", at " + describe(record_->model, now_, q_, v_));
}

// What is said to hold already is the question's own business.
void Run::begin() {
  if (record_->model.normalize) record_->model.normalize(q_);
  record_->segments.push_back({now_, {}, {Node{0, Vector(q_.size() + v_.size())}}});
  Segment& first = record_->segments.back();
  first.nodes.back().y << q_, v_;
  first.active = rules_.begin(now_, q_);
  if (!first.active.empty()) require_constraints(first.active);
  first.nodes.back().y << q_, v_;
}

void Run::require_constraints(const ActiveSet& holding) {
  constexpr double rounding = 1e-13;
  ImpulseSolver impulse(record_->model);
  const double allowed = std::max(options_.accuracy, rounding);
  for (const std::size_t i : holding) {
    const double residual = impulse.relative_residual({i}, now_, q_, v_);
    if (residual <= allowed || options_.project_initial) continue;
    std::ostringstream message;
    message << "the initial velocities violate the constraint " << record_->model.constraints[i].name
            << ", which holds from the start: its residual relative to its terms is " << residual
            << "; allowed: at most " << allowed << ", or have them projected ("
            << describe(record_->model, now_, q_, v_) << ")";
    throw std::invalid_argument(message.str());
  }
  Impulse projected;
  impulse.solve(holding, now_, q_, v_, projected);
  v_ = projected.velocity;
}

void Run::go() {
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
    begin();
    for (;;) {
      switch_constraints();
      if (now_ >= end_) return stop(Stop::reached_end, "the requested end");
      if (record_->switches.size() >= options_.max_switches) {
        return stop(Stop::too_many_switches, std::to_string(options_.max_switches) + " switches, the limit");
      }
      if (!advance()) return;
    }
  } catch (const Interrupted&) {
    if (thrown_by_monitor) std::rethrow_exception(thrown_by_monitor);
    stop_cancelled();
  } catch (const ConstraintError& error) {
    stop(stop_of(error.reason()), error.what());
  } catch (const LivelockError& error) {
    stop(Stop::livelock, error.what());
  } catch (const NotFinite& error) {
    stop_not_finite(error);
  } catch (const StepError& error) {
    stop(Stop::no_step, "the integrator finds no step that is accurate enough (" + std::string(error.what()) +
                            "), at " + describe(record_->model, now_, q_, v_));
  }
}

void Run::switch_constraints() {
  constexpr double fraction = 1e-3;
  const double ahead = integrator_.last_step() > 0 ? integrator_.last_step() : fraction * (end_ - now_);
  std::vector<Switch> changes;
  const auto keep = [&] {
    for (Switch& change : changes) {
      change.index = record_->switches.size();
      for (const std::size_t i : change.applied) ++record_->applied[i];
      record_->switches.push_back(std::move(change));
    }
    if (changes.empty()) return;
    Segment next{now_, rules_.active(), {Node{0, Vector(q_.size() + v_.size())}}};
    next.nodes.back().y << q_, v_;
    record_->segments.push_back(std::move(next));
  };
  try {
    rules_.switch_constraints(now_, q_, v_, integrator_.sizes(q_), ahead, changes);
  } catch (...) {
    keep();
    throw;
  }
  keep();
}

bool Run::advance() {
  Segment& segment = record_->segments.back();
  const double until = std::min(end_, rules_.next_instant(now_));
  const double end = until - segment.start;
  bool changed = false;
  const auto take_last = [&] {
    const Node& node = segment.nodes.back();
    now_ = node.x < end ? std::min(segment.start + node.x, until) : until;
    q_ = node.y.head(q_.size());
    v_ = node.y.tail(v_.size());
  };
  integrator_.begin(segment, rules_.monitored(now_, q_, v_, integrator_.sizes(q_)), end);
  while (!changed && segment.nodes.back().x < end) {
    if (integrator_.effort().steps >= options_.max_steps) {
      take_last();
      stop(Stop::too_many_steps, "more than " + std::to_string(options_.max_steps) + " steps");
      return false;
    }
    try {
      changed = integrator_.advance();
    } catch (...) {
      take_last();
      throw;
    }
    InterruptScope::count_from_here();
    if (is_cancelled()) {
      take_last();
      stop_cancelled();
      return false;
    }
  }
  take_last();
  return !accumulates(changed);
}

bool Run::is_cancelled() const {
  if (!options_.monitor || record_->segments.empty()) return false;
  const Segment& segment = record_->segments.back();
  const double time = segment.start + segment.nodes.back().x;
  return !options_.monitor({time, integrator_.effort().steps, record_->switches.size()});
}

// At the rate of the last instants the number of switches allowed would be used up in a thousandth of the
// time.
bool Run::accumulates(bool changed) {
  constexpr std::size_t many = 1000;
  if (!changed) return false;
  instants_.push_back(now_);
  if (instants_.size() <= many) return false;
  const double span = now_ - instants_.front();
  instants_.pop_front();
  if (span > (end_ - begin_) / static_cast<double>(options_.max_switches)) return false;
  stop(Stop::accumulation,
       "switches accumulate faster than max_switches allows, at " + describe(record_->model, now_, q_));
  return true;
}

}  // namespace

Solution solve(const Model& model, const Initial& initial, double duration, const Options& options) {
  check(model, initial, duration, options);
  check_terms(model, initial.time, initial.q, initial.v);
  auto record = std::make_unique<Solution::Record>();
  record->model = model;
  record->applied.assign(model.constraints.size(), 0);
  Run run(*record, initial, duration, options);
  run.go();
  record->effort = run.effort();
  return Solution(std::move(record));
}

}  // namespace hybrid_sphere::mechanics
