#include "ros/system/system_plant.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "hybrid_sphere/interrupt/interrupted.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

using mechanics::Index;
using mechanics::Status;
using mechanics::Stop;
using mechanics::Vector;

/// The motion has come to its end.
class Ended : public std::runtime_error {
 public:
  explicit Ended(const Status& status)
      : std::runtime_error(std::string(mechanics::to_string(status.stop)) + ": " + status.message),
        time_(status.time) {}
  double time() const { return time_; }

 private:
  double time_;
};

bool all_finite(const mechanics::State& state) {
  return state.q.allFinite() && state.v.allFinite() && state.multipliers.allFinite() &&
         std::isfinite(state.energy) && std::isfinite(state.kinetic_energy) && std::isfinite(state.residual);
}

/// Why an input cannot be one; else empty.
std::string fault_of(const Vector& input, const Vector& before) {
  if (before.size() == 0) return "this system has no input";
  if (input.size() != before.size()) {
    return text::refusal("data: " + std::to_string(input.size()) + " numbers",
                         std::to_string(before.size()) + " finite numbers");
  }
  for (Index i = 0; i < input.size(); ++i) {
    if (!std::isfinite(input[i]))
      return text::refusal("data[" + std::to_string(i) + "]: " + text::shortest(input[i]), "a finite number");
  }
  return {};
}

}  // namespace

SystemPlant::SystemPlant(std::shared_ptr<const SystemPlugin> system, double accuracy, double duration,
                         double timeout, mechanics::SwitchSink sink, std::function<void()> ended)
    : DrivenPlant(std::move(ended), "a reset"),
      system_(std::move(system)),
      sink_(std::move(sink)),
      duration_(duration),
      begin_(system_->initial().time),
      input_(system_->initial_input()),
      input_age_(timeout) {
  options_.accuracy = accuracy;
  options_.monitor = [this](const mechanics::Progress&) { return !should_stop(); };
  plant_.emplace(make_plant());
  names_ = plant_->model();
}

mechanics::Plant SystemPlant::make_plant() const {
  const auto model = [system = system_](const Vector& input) { return system->model(input); };
  return {model, system_->initial_input(), system_->initial(), options_, duration_};
}

double SystemPlant::time() const { return under_way() ? figures_.time : plant_->time() - begin_; }

SystemPlant::Failure SystemPlant::failure_of(const std::exception& error) const {
  if (const auto* end = dynamic_cast<const Ended*>(&error)) return {end->time() - begin_, end->what()};
  return DrivenPlant::failure_of(error);
}

// The limits of steps and switches are those of one question: time has none.
void SystemPlant::advance(double time, const mechanics::SwitchSink& sink) {
  const double until = std::max(begin_ + time, plant_->time());
  for (;;) {
    const Status status = plant_->advance(until, sink);
    switch (status.stop) {
      case Stop::reached_end: return;
      case Stop::cancelled: throw Interrupted();
      case Stop::too_many_steps:
      case Stop::too_many_switches: break;
      default: throw Ended(status);
    }
  }
}

void SystemPlant::compute_beside(double time) {
  advance(time,
          [this](const mechanics::Switch& event) { beside_.push(event, [this] { return is_to_stop(); }); });
}

void SystemPlant::report_kept() { beside_.report(sink_); }

void SystemPlant::keep_present() {
  state();
  figures_ = {plant_->time() - begin_, plant_->switches(), plant_->evaluations()};
}

const mechanics::State* SystemPlant::state() {
  if (!under_way()) guarded([&] { show(plant_->state()); });
  return shown_ ? &*shown_ : nullptr;
}

void SystemPlant::show(const mechanics::State& state) {
  find_forces(state);
  if (all_finite(state) && rate_.allFinite() && forces_.allFinite()) {
    shown_ = state;
    return;
  }
  shown_.reset();
  halt_at(state.time - begin_, "the state is not finite", "nothing is sent");
}

void SystemPlant::find_forces(const mechanics::State& state) {
  const mechanics::Model& model = plant_->model();
  rate_.resize(state.q.size());
  model.equations->rate(state.q, state.v, rate_);
  forces_.setZero(state.v.size());
  Vector value;
  mechanics::Matrix gradient;
  for (std::size_t i = 0; i < model.constraints.size(); ++i) {
    const mechanics::ConstraintFunction& function = *model.constraints[i].function;
    const auto multipliers = state.multipliers.segment(model.multiplier_of(i), function.size());
    if (multipliers.isZero(0)) continue;  // that of one without force is not evaluated
    value.resize(function.size());
    gradient.resize(function.size(), state.v.size());
    function.evaluate(state.time, state.q, state.v, value, gradient);
    forces_ += gradient.transpose() * multipliers;
  }
}

double SystemPlant::estimated_error() {
  const mechanics::State* now = state();
  return now ? now->estimated_error : 0;
}

std::string SystemPlant::motion() {
  const mechanics::State* now = state();
  return now ? "the system is at " + mechanics::describe(names_, now->time, now->q, now->v) : std::string();
}

void SystemPlant::take_input(const Vector& input) {
  const std::string fault = fault_of(input, input_);
  if (fault.empty()) {
    next_input_ = input;
    input_age_.begin();
  } else {
    drops_.add(fault);
  }
}

void SystemPlant::apply_input(double clock) {
  if (halted() || under_way()) return;
  if (input_age_.is_over(clock) && input_ != system_->initial_input()) {
    next_input_ = system_->initial_input();
    drops_.add("no newer one within " + text::shortest(input_age_.longest()) +
               " s (command_timeout): the initial input acts");
  }
  if (!next_input_) return;
  const Vector next = *std::exchange(next_input_, std::nullopt);
  if (next == input_) return;  // nothing begins anew
  guarded([&] {
    try {
      plant_->set_input(next);
      input_ = next;
    } catch (const std::invalid_argument& error) {
      drops_.add(error.what());
    }
  });
}

void SystemPlant::reset() {
  stand();
  forget_pursuit();
  forget_halt();
  shown_.reset();
  next_input_.reset();
  guarded([&] {
    plant_.emplace(make_plant());
    input_ = plant_->input();
  });
}

}  // namespace hybrid_sphere::ros_interface
