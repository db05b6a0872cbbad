#include "hybrid_sphere/mechanics/plant.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "mechanics/active_constraints.hpp"
#include "mechanics/check_initial.hpp"
#include "mechanics/constraint_residual.hpp"
#include "mechanics/time_stepper.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::mechanics {

struct Plant::Snapshot::Data {
  Model model;
  Vector input;
  TimeStepper::Memory memory;
  bool has_started;
};

struct Plant::Impl {
  Impl(Model for_input, const Initial& initial, const Options& options, double horizon)
      : model(std::move(for_input)), accuracy(options.accuracy), stepper(model, initial, options, {horizon}) {
    status = stepper.start(initial.active);
    has_started = status.stop == Stop::reached_end;
  }

  /// Whether the motion goes on after that.
  bool goes_on() const {
    switch (status.stop) {
      case Stop::reached_end:
      case Stop::cancelled:
      case Stop::too_many_steps:
      case Stop::too_many_switches: return true;
      default: return false;
    }
  }

  /// The callback, during which the plant knows that it is in it.
  SwitchSink guarded(const SwitchSink& on_switch) {
    if (!on_switch) return {};
    return [this, &on_switch](const Switch& event) {
      const InCallback in(is_in_callback);
      status.time = event.time;
      on_switch(event);
    };
  }
  void refuse_in_callback(const std::string& function) const {
    if (!is_in_callback) return;
    throw std::logic_error(function +
                           "() is called in on_switch, while the plant is being advanced; allowed there: "
                           "time(), state(), save(), set_input()");
  }

  /// Refuses a model whose constraints on positions do not hold, or overlap, where the plant is.
  void refuse_other_positions(const Model& next, const TimeStepper::Memory& memory) const;

  struct InCallback {
    explicit InCallback(bool& flag) : is_in(flag) { is_in = true; }
    ~InCallback() { is_in = false; }
    InCallback(const InCallback&) = delete;
    InCallback& operator=(const InCallback&) = delete;
    bool& is_in;
  };

  Model model;  // for the input
  double accuracy;
  bool is_in_callback = false;
  TimeStepper stepper;
  Status status;
  bool has_started = false;  // whether the initial state was possible
  ModelOfInput model_of_input;
  Vector input;
};

namespace {

Model checked(Model model, const Initial& initial, const Options& options, double horizon) {
  check(model, initial, options);
  check_terms(model, initial.time, initial.q, initial.v);
  if (!(horizon >= least_time && std::isfinite(horizon))) {
    refuse("horizon", horizon, "a number >= 1e-100");
  }
  return model;
}

void check_input(const Vector& input, Index size) {
  if (input.size() != size) {
    throw std::invalid_argument("the input has " + std::to_string(input.size()) + " numbers, not " +
                                std::to_string(size));
  }
  for (Index i = 0; i < size; ++i) {
    if (!std::isfinite(input[i])) refuse("input[" + std::to_string(i) + "]", input[i], "a finite number");
  }
}

/// Refuses a model that is not one of the same system for another input.
void check_same_system(const Model& before, const Model& after) {
  bool is_same = before.coordinates == after.coordinates && before.velocities == after.velocities &&
                 before.constraints.size() == after.constraints.size() &&
                 before.events.size() == after.events.size();
  for (std::size_t i = 0; is_same && i < before.constraints.size(); ++i) {
    const Constraint& a = before.constraints[i];
    const Constraint& b = after.constraints[i];
    is_same = a.name == b.name && a.function->size() == b.function->size() &&
              (a.schedule.guard == nullptr) == (b.schedule.guard == nullptr) &&
              a.unilateral.has_value() == b.unilateral.has_value() &&
              a.friction.has_value() == b.friction.has_value() &&
              (!a.friction || a.friction->contact == b.friction->contact);
  }
  if (!is_same) {
    throw std::invalid_argument(
        "the model for this input has other coordinates, velocities, constraints or events");
  }
}

}  // namespace

void Plant::Impl::refuse_other_positions(const Model& next, const TimeStepper::Memory& memory) const {
  const double allowed = std::max(accuracy, residual_roundoff);
  const Vector q = memory.node.y.head(next.equations->coordinates());
  const Vector v = memory.node.y.tail(next.equations->velocities());
  const Vector sizes = q.cwiseAbs().cwiseMax(stepper.sizes().q);
  for (std::size_t i = 0; i < next.constraints.size(); ++i) {
    const Constraint& constraint = next.constraints[i];
    const bool holds = contains(memory.rules.active, i);
    if (!constraint.function->has_position() || !(holds || constraint.unilateral)) continue;
    const double off = relative_position(constraint, memory.time, q, v, sizes);
    if (off <= allowed) continue;
    if (!holds && constraint.schedule.guard->value(memory.time, q) < 0) continue;  // the gap is open
    throw std::invalid_argument("with this input the positions do not satisfy the constraint " +
                                constraint.name + ": they are off by " + text::shortest(off) +
                                " of its terms; allowed: at most " + text::shortest(allowed) + " (" +
                                describe(next, memory.time, q) + ")");
  }
}

Plant::Plant(const Model& model, const Initial& initial, const Options& options, double horizon)
    : impl_(std::make_unique<Impl>(checked(model, initial, options, horizon), initial, options, horizon)) {}

Plant::Plant(ModelOfInput model, const Vector& input, const Initial& initial, const Options& options,
             double horizon)
    : Plant((check_input(input, input.size()), model(input)), initial, options, horizon) {
  impl_->model_of_input = std::move(model);
  impl_->input = input;
}

Plant::~Plant() = default;
Plant::Plant(Plant&&) noexcept = default;
Plant& Plant::operator=(Plant&&) noexcept = default;

const Model& Plant::model() const { return impl_->model; }
double Plant::time() const { return impl_->stepper.time(); }
const Vector& Plant::input() const { return impl_->input; }
const Projection& Plant::projection() const { return impl_->stepper.projection(); }
std::uint64_t Plant::switches() const { return impl_->stepper.switches(); }
std::uint64_t Plant::steps() const { return impl_->stepper.effort().steps; }
std::uint64_t Plant::evaluations() const { return impl_->stepper.effort().evaluations; }

Status Plant::advance(double time, const SwitchSink& on_switch) {
  if (!(time >= this->time() && std::isfinite(time))) {
    refuse("time", time, "a number >= " + text::shortest(this->time()));
  }
  impl_->refuse_in_callback("advance");
  if (!impl_->goes_on()) return impl_->status;
  // The callback sees this status; it stays if the callback throws.
  impl_->status = {Stop::reached_end, this->time(), "the last switch"};
  impl_->status = impl_->stepper.advance(time, impl_->guarded(on_switch));
  return impl_->status;
}

State Plant::state() const {
  return state_of(impl_->model, impl_->stepper.segment(), time(), impl_->status, impl_->stepper.precision());
}

void Plant::set_input(const Vector& input) {
  if (!impl_->model_of_input) throw std::invalid_argument("this plant has no input");
  check_input(input, impl_->input.size());
  if (!impl_->has_started) {
    throw std::invalid_argument("this plant has not started: " + impl_->status.message +
                                "; allowed: another plant, with another initial state or input");
  }
  Model model = impl_->model_of_input(input);
  check(model);
  check_same_system(impl_->model, model);
  // What may fail comes first.
  Vector copy = input;
  TimeStepper::Memory memory = impl_->stepper.memory();
  impl_->refuse_other_positions(model, memory);
  impl_->model = std::move(model);
  impl_->input = std::move(copy);
  impl_->stepper.begin_again(memory);
  // The new model may continue where the previous one stopped.
  if (!impl_->goes_on()) impl_->status = {Stop::reached_end, memory.time, "another input"};
}

Plant::Snapshot Plant::save() const {
  return Snapshot(std::make_shared<const Snapshot::Data>(
      Snapshot::Data{impl_->model, impl_->input, impl_->stepper.memory(), impl_->has_started}));
}

void Plant::restore(const Snapshot& snapshot) {
  impl_->refuse_in_callback("restore");
  const Snapshot::Data& data = snapshot.data();
  check_same_system(impl_->model, data.model);
  impl_->model = data.model;
  impl_->input = data.input;
  impl_->stepper.restore(data.memory);
  impl_->has_started = data.has_started;
  impl_->status = {Stop::reached_end, data.memory.time, "a state that was saved"};
}

}  // namespace hybrid_sphere::mechanics
