#include "hybrid_sphere/ros/plant.hpp"

#include <ros/console.h>

#include <algorithm>
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

Plant::Plant(const scene::Scene& scene, double command_timeout, Simulation::SwitchSink sink)
    : simulation_(scene),
      sink_(std::move(sink)),
      solver_(scene.solver),
      estimate_(scene),
      command_(command_timeout) {}

void Plant::advance_to(double time) {
  if (halted()) return;
  try {
    simulation_.advance_to(time, sink_);
  } catch (const HaltedError& error) {
    halt_ = said(error.time(), error.what());
    ROS_ERROR("%s; the last state is held until a reset, a new initial state or a new map", halt_.c_str());
  }
}

const State* Plant::state() {
  const State& state = simulation_.state();
  if (all_finite(state)) return &state;
  if (!halted()) {
    halt_ = said(state.time, "a number of the state is not finite");
    ROS_ERROR("%s; nothing is sent until a reset, a new initial state or a new map", halt_.c_str());
  }
  return nullptr;
}

double Plant::estimated_error() {
  if (const State* now = state()) {
    fastest_spin_ = std::max(fastest_spin_, now->twist.angular_velocity.norm());
  }
  return estimate_(static_cast<double>(switches()), time(), fastest_spin_, simulation_.estimated_error());
}

void Plant::apply_command(Command::Wall::time_point now) {
  if (halted()) return;
  try {
    simulation_.set_command(command_.at(now));
  } catch (const std::invalid_argument& error) {
    command_drops_.add(error.what());
    command_.drop();
  }
}

void Plant::set_accuracy(double accuracy) {
  solver_.accuracy = accuracy;
  simulation_.set_accuracy(accuracy);
}

void Plant::set_ground(const std::shared_ptr<const Ground>& ground, const ErrorEstimate& estimate) {
  try {
    simulation_.set_ground(ground);
  } catch (const std::invalid_argument& error) {  // the map was checked without a command
    command_drops_.add(error.what());
    command_.drop();
    simulation_.set_command({});
    simulation_.set_ground(ground);
  }
  estimate_ = estimate;
  halt_.clear();
}

void Plant::set_initial_state(const scene::InitialState& state) {
  restart();
  simulation_.set_initial_state(state);
}

void Plant::reset() {
  restart();
  simulation_.reset();
}

void Plant::restart() {
  command_.drop();
  simulation_.set_command({});
  halt_.clear();
  fastest_spin_ = 0;
}

}  // namespace hybrid_sphere::ros_interface
