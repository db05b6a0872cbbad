#include "ros/node/plant.hpp"

#include <algorithm>
#include <exception>
#include <sstream>
#include <utility>

#include "text/refusal.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

bool all_finite(const State& state) {
  return state.position.allFinite() && state.orientation.coeffs().allFinite() &&
         state.twist.velocity.allFinite() && state.twist.angular_velocity.allFinite() &&
         state.slip.allFinite();
}

}  // namespace

Plant::Plant(const scene::Scene& scene, double command_timeout, Simulation::SwitchSink sink,
             std::function<void()> ended)
    : DrivenPlant(std::move(ended), "a reset, a new initial state or a new map"),
      simulation_(scene),
      sink_(std::move(sink)),
      solver_(scene.solver),
      estimate_(scene),
      command_(command_timeout) {
  simulation_.set_interrupt([this] { return should_stop(); });
}

/// Misuse that a caller has an answer to passes before.
Plant::Failure Plant::failure_of(const std::exception& error) const {
  if (const auto* halt = dynamic_cast<const HaltedError*>(&error)) return {halt->time(), halt->what()};
  return DrivenPlant::failure_of(error);
}

void Plant::keep_present() {
  state();
  reaction();
  figures_.time = simulation_.time();
  figures_.switches = simulation_.switches();
  figures_.evaluations = simulation_.evaluations();
  figures_.estimated_error = simulation_.estimated_error();
}

void Plant::compute_beside(double time) {
  simulation_.advance_to(time, [this](const Switch& event) {
    beside_.push({event, std::string(event.from_region), std::string(event.to_region)},
                 [this] { return is_to_stop(); });
  });
}

void Plant::report_kept() {
  beside_.report([this](KeptSwitch& kept) {
    kept.event.from_region = kept.from;
    kept.event.to_region = kept.to;
    sink_(kept.event);
  });
}

std::string Plant::motion() {
  const State* now = state();
  if (now == nullptr) return {};
  std::ostringstream text;
  text.precision(3);
  text << "the sphere moves at " << now->twist.velocity.norm() << " m/s and turns at "
       << now->twist.angular_velocity.norm() << " rad/s";
  return text.str();
}

const State* Plant::state() {
  if (!under_way()) guarded([&] { show(simulation_.state()); });
  return is_shown_ ? &shown_ : nullptr;
}

void Plant::show(const State& state) {
  is_shown_ = all_finite(state);
  if (!is_shown_) {
    halt_at(state.time, "the state is not finite", "nothing is sent");
    return;
  }
  shown_ = state;
  shown_region_.assign(state.region);
  shown_.region = shown_region_;
}

Vector3d Plant::reaction() {
  if (under_way()) return figures_.reaction;
  guarded([&] { figures_.reaction = simulation_.reaction(); });
  return figures_.reaction;
}

double Plant::estimated_error() {
  if (const State* now = state()) {
    fastest_spin_ = std::max(fastest_spin_, now->twist.angular_velocity.norm());
  }
  const double of_steps = under_way() ? figures_.estimated_error : simulation_.estimated_error();
  return estimate_(static_cast<double>(switches()), time(), fastest_spin_, of_steps);
}

void Plant::apply_command(double clock) {
  if (halted() || under_way()) return;
  if (command_.drop_if_too_old(clock))
    command_drops_.add("no newer one within " + text::shortest(command_.timeout()) + " s (command_timeout)");
  guarded([&] {
    try {
      simulation_.set_command(command_.wrench());
    } catch (const std::invalid_argument& error) {
      command_drops_.add(error.what());
      command_.drop();
    }
  });
}

void Plant::set_accuracy(double accuracy) {
  if (accuracy == solver_.accuracy) return;
  stand();
  solver_.accuracy = accuracy;
  guarded([&] { simulation_.set_accuracy(accuracy); });
}

void Plant::kick(const Vector2d& change) {
  stand();
  if (!halted()) guarded([&] { simulation_.kick(sphere().mass() * change); });
}

void Plant::set_ground(const std::shared_ptr<const Ground>& ground, const ErrorEstimate& estimate) {
  stand();
  forget_halt();
  guarded([&] {
    try {
      simulation_.set_ground(ground);
    } catch (const std::invalid_argument& error) {  // the map was checked without a command
      command_drops_.add(error.what());
      command_.drop();
      simulation_.set_command({});
      simulation_.set_ground(ground);
    }
  });
  estimate_ = estimate;
}

void Plant::set_initial_state(const scene::InitialState& state) {
  restart();
  guarded([&] {
    simulation_.set_command({});
    simulation_.set_initial_state(state);
  });
}

void Plant::set_state(const scene::InitialState& state) {
  stand();
  forget_pursuit();
  forget_halt();
  is_shown_ = false;
  guarded([&] { simulation_.set_state(state); });
}

void Plant::reset() {
  restart();
  guarded([&] {
    simulation_.set_command({});
    simulation_.reset();
  });
}

void Plant::restart() {
  stand();
  forget_pursuit();
  command_.drop();
  forget_halt();
  fastest_spin_ = 0;
  is_shown_ = false;
}

}  // namespace hybrid_sphere::ros_interface
