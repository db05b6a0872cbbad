#include "ros/node/plant.hpp"

#include <ros/console.h>

#include <algorithm>
#include <exception>
#include <sstream>
#include <utility>

namespace hybrid_sphere::ros_interface {
namespace {

bool all_finite(const State& state) {
  return state.position.allFinite() && state.orientation.coeffs().allFinite() &&
         state.twist.velocity.allFinite() && state.twist.angular_velocity.allFinite() &&
         state.slip.allFinite();
}

std::string said(double time, const std::string& reason) {
  std::ostringstream text;
  text.precision(9);
  text << "halted at t = " << time << " s: " << reason;
  return text.str();
}

}  // namespace

Plant::Plant(const scene::Scene& scene, double command_timeout, Simulation::SwitchSink sink,
             std::function<void()> ended)
    : simulation_(scene),
      sink_(std::move(sink)),
      ended_(std::move(ended)),
      solver_(scene.solver),
      estimate_(scene),
      command_(command_timeout) {
  simulation_.set_interrupt([this] { return computation_.should_stop(); });
}

/// The one place where what the simulation throws becomes a halt. Misuse that a caller has an answer to
/// passes.
template <class Function>
void Plant::guarded(const Function& function) {
  constexpr const char* last_state = "the last state is held";
  try {
    function();
  } catch (const HaltedError& error) {
    halt_at(error.time(), error.what(), last_state);
  } catch (const std::exception& error) {
    halt_at(time(), std::string("the computation failed: ") + error.what(), last_state);
  }
}

void Plant::halt_at(double time, const std::string& reason, const char* held) {
  if (halted()) return;
  halt_ = said(time, reason);
  ROS_ERROR("%s; %s until a reset, a new initial state or a new map", halt_.c_str(), held);
}

void Plant::fail(const std::string& reason) { halt_at(time(), reason, "the last state is held"); }

bool Plant::advance_to(double time) {
  if (halted()) return true;
  if (under_way()) return false;
  pursuit_.reset();
  bool arrived = true;
  guarded([&] { arrived = computation_.attempt([&] { simulation_.advance_to(time, sink_); }); });
  if (!arrived) go_on_beside(time);
  return arrived;
}

void Plant::go_on_beside(double time) {
  state();
  reaction();
  figures_.time = simulation_.time();
  figures_.switches = simulation_.switches();
  figures_.evaluations = simulation_.evaluations();
  figures_.estimated_error = simulation_.estimated_error();
  pursuit_ = Pursuit{Wall::now(), time};
  const auto report = [this](const Switch& event) {
    beside_.push(event, [this] { return computation_.is_to_stop(); });
  };
  computation_.go_on([this, time, report] { simulation_.advance_to(time, report); }, ended_);
}

bool Plant::collect() {
  beside_.report(sink_);
  bool ended = !under_way();
  guarded([&] { ended = computation_.finish() || ended; });
  if (under_way()) return false;
  beside_.report(sink_);
  return true;
}

void Plant::stand() {
  guarded([&] { computation_.interrupt(); });
  beside_.report(sink_);
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

void Plant::apply_command(Command::Wall::time_point now) {
  if (halted() || under_way()) return;
  guarded([&] {
    try {
      simulation_.set_command(command_.at(now));
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
  halt_.clear();
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
  pursuit_.reset();
  halt_.clear();
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
  pursuit_.reset();
  command_.drop();
  halt_.clear();
  fastest_spin_ = 0;
  is_shown_ = false;
}

}  // namespace hybrid_sphere::ros_interface
