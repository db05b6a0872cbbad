#include "cli/three_stage_summary.hpp"

#include <algorithm>
#include <cmath>
#include <ostream>
#include <sstream>

namespace hybrid_sphere::cli::three_stage {
namespace {

std::string plural(std::uint64_t n, const std::string& one) {
  return std::to_string(n) + " " + one + (n == 1 ? "" : one.back() == 's' || one.back() == 'h' ? "es" : "s");
}

double last_instant(const mechanics::Solution& solution) {
  return solution.switches().empty() ? solution.begin() : solution.switches().back().time;
}

/// What is worth a remark: a constraint that never held, or held all the time.
std::string remark(const mechanics::Schedule& schedule, const mechanics::ConstraintReport& report,
                   double whole) {
  if (report.held == 0 && report.applied == 0) {
    if (schedule.guard) return "; its guard was never positive";
    std::ostringstream text;
    text << "; scheduled to hold from t = " << schedule.begin << " s";
    if (std::isfinite(schedule.end)) text << " to " << schedule.end << " s";
    return text.str();
  }
  if (report.held >= whole && schedule.guard) return "; its guard was positive throughout";
  return "";
}

}  // namespace

Summary::Summary(const mechanics::catalogue::Example& example, const mechanics::Model& model,
                 const mechanics::Solution& solution, double step, double accuracy)
    : example_(&example),
      model_(&model),
      solution_(&solution),
      window_(accuracy * (solution.end() - solution.begin())),
      deviation_(model, solution.at(solution.begin()).q, solution.end() - solution.begin(), step),
      begin_(last_instant(solution)) {
  const mechanics::State start = solution.at(begin_);
  if (start.active.empty()) return;
  for (const auto& invariant : example.invariants) invariants_.push_back(invariant.value(start));
  drifts_.assign(invariants_.size(), 0);
}

// Where the motion decides when a switch is, that time has an error of its own; next to it velocities before
// the switch would be compared with those after it. The motion may also end just before a switch.
bool Summary::comparable(const mechanics::State& state) const {
  const auto guard_of = [this](std::size_t i) { return model_->constraints[i].schedule.guard.get(); };
  const auto guarded = [&](const mechanics::ActiveSet& set) {
    return std::any_of(set.begin(), set.end(), guard_of);
  };
  const auto& switches = solution_->switches();
  const bool near_switch = std::any_of(switches.begin(), switches.end(), [&](const mechanics::Switch& event) {
    return std::abs(event.time - state.time) <= window_ &&
           (guarded(event.applied) || guarded(event.released));
  });
  if (near_switch) return false;
  mechanics::Vector rate;
  model_->equations->rate(state.q, state.v, rate);
  for (std::size_t i = 0; i < model_->constraints.size(); ++i) {
    const mechanics::Guard* const guard = guard_of(i);
    if (guard == nullptr) continue;
    const double way = std::abs(guard->rate(state.time, state.q, rate)) * window_;
    if (way > 0 && std::abs(guard->value(state.time, state.q)) <= way) return false;
  }
  return true;
}

void Summary::add(const mechanics::State& state) {
  ++outputs_;
  residual_ = std::max(residual_, state.residual);
  if (state.time >= begin_) {
    for (std::size_t i = 0; i < drifts_.size(); ++i) {
      const double drift = std::abs(example_->invariants[i].value(state) - invariants_[i]);
      drifts_[i] = std::max(drifts_[i], drift);
    }
  }
  if (!example_->known) return;
  const auto known = example_->known(state.time);
  if (!known) return;
  ++covered_;
  if (comparable(state)) deviation_.add(state, *known);
}

void Summary::write_deviation(std::ostream& err) const {
  const std::string outputs = plural(outputs_, "output");
  if (!example_->known) {
    err << "  no known solution to compare with\n";
  } else if (covered_ == 0) {
    err << "  the known solution covers 0 of " << outputs << '\n';
  } else if (deviation_.states() == 0) {
    err << "  the known solution covers " << covered_ << " of " << outputs
        << "; compared at none: too close to a switch or to where the motion stopped\n";
  } else {
    err << "  deviation from the known solution, relative to the scale of the motion: q "
        << deviation_.of_coordinates() << ", v " << deviation_.of_velocities() << ", lambda "
        << deviation_.of_multipliers() << " (compared at " << deviation_.states() << " of " << outputs
        << ")\n";
  }
}

void Summary::write(const std::string& name, std::ostream& err) const {
  const mechanics::Status& status = solution_->status();
  std::ostringstream text;
  text << "three_stage: " << name << ": " << mechanics::to_string(status.stop) << " at t = " << status.time
       << " s; " << plural(solution_->switches().size(), "switch") << ", "
       << plural(solution_->steps(), "step") << ", " << plural(solution_->evaluations(), "evaluation") << ", "
       << plural(outputs_, "output") << '\n';
  text.precision(2);
  write_deviation(text);
  write_invariants(text);
  text << "  largest residual of the constraints that held: " << residual_ << '\n';
  write_constraints(text);
  err << text.str();
}

void Summary::write_invariants(std::ostream& err) const {
  for (std::size_t i = 0; i < drifts_.size(); ++i) {
    std::ostringstream text;
    text << "  " << example_->invariants[i].name << " has drifted by at most ";
    text.precision(2);
    text << drifts_[i];
    text.precision(6);
    text << " from " << invariants_[i] << " since "
         << (solution_->switches().empty() ? "the start" : "the last switch") << '\n';
    err << text.str();
  }
}

void Summary::write_constraints(std::ostream& err) const {
  const double whole = solution_->end() - solution_->begin();
  const auto reports = solution_->constraints();
  for (std::size_t i = 0; i < reports.size(); ++i) {
    std::ostringstream text;
    text << "  " << reports[i].name << ": applied " << plural(reports[i].applied, "time") << ", held "
         << reports[i].held << " of " << whole << " s"
         << remark(model_->constraints[i].schedule, reports[i], whole) << '\n';
    err << text.str();
  }
}

}  // namespace hybrid_sphere::cli::three_stage
