// What the node is asked for between ticks.

#include <algorithm>
#include <cmath>

#include "hybrid_sphere/ros/initial_state_message.hpp"
#include "hybrid_sphere/ros/simulator_node.hpp"

namespace hybrid_sphere::ros_interface {

MapServer::Exchange SimulatorNode::put_in_force(const std::shared_ptr<const Ground>& ground,
                                                const ErrorEstimate& estimate) {
  const bool halted = plant_.halted();
  plant_.set_ground(ground, estimate);
  if (halted) clock_.resume(plant_.time());
  act_at_once();
  const State* state = plant_.state();
  return {present(), state ? state->position : Vector2d::Zero()};
}

void SimulatorNode::take_command(const geometry_msgs::WrenchStamped& message) {
  try {
    plant_.take_command(wrench_from_message(message, frames_.world, body_), Wall::now());
  } catch (const scene::SceneError& error) {
    plant_.command_drops().add(error.what());
  }
}

bool SimulatorNode::set_initial_state(SetInitialState::Request& request,
                                      SetInitialState::Response& response) {
  try {
    plant_.set_initial_state(initial_state_from_message(request, plant_.sphere().radius()));
    start_anew();
  } catch (const scene::SceneError& error) {
    response.message = error.what();
    response.success = false;
    return true;
  }
  response.success = true;
  return true;
}

bool SimulatorNode::reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  plant_.reset();
  start_anew();
  response.success = true;
  return true;
}

/// After a new initial state.
void SimulatorNode::start_anew() {
  clock_.restart();
  if (const State* state = plant_.state()) {
    markers_.start_at(state->position);
    map_server_.keep_in_view(state->position);
  }
  plant_.let_ground_act();
  if (!clock_.runs()) publish_where_it_stands();
}

/// After a change of the ground or of the velocities at the present time.
void SimulatorNode::act_at_once() {
  clock_.distinguish();
  plant_.let_ground_act();
  if (!clock_.runs()) publish_where_it_stands();
}

void SimulatorNode::publish_where_it_stands() {
  const ros::Time stamp = present();
  clock_publisher_.publish_at_once(stamp);
  state_publisher_.publish(stamp);
}

void SimulatorNode::adjust(const Adjustable& values) {
  const Wall::time_point now = Wall::now();
  if (values.rate != clock_.rate()) clock_.set_rate(values.rate, now);
  if (values.real_time_factor != clock_.factor()) clock_.set_factor(values.real_time_factor, now);
  plant_.set_accuracy(values.accuracy);
  markers_.set_style(values.markers);
}

bool SimulatorNode::pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
  response.success = true;
  if (request.data) {
    response.message = clock_.runs() ? "paused" : "was paused already";
    clock_.stand();
    clock_publisher_.publish_at_once(present());
  } else {
    response.message = clock_.runs() ? "was running already" : "runs";
    clock_.run(Wall::now());
  }
  return true;
}

bool SimulatorNode::step(Step::Request& request, Step::Response& response) {
  constexpr double longest = 1e9;  // [s]
  const std::uint64_t passed_before = passed_;
  if (!(request.duration > 0 && request.duration <= longest)) {
    response.message = "duration: " + scene::Tree(request.duration).describe() +
                       " is refused; allowed: a number greater than 0, up to 1e9 [s]";
  } else if (clock_.runs()) {
    response.message = "the simulation runs: only a paused one takes steps";
  } else {
    response.message = run_to(clock_.end_of_step(request.duration));
  }
  response.success = response.message.empty();
  response.switches =
      static_cast<std::uint32_t>(std::min<std::uint64_t>(passed_ - passed_before, 0xffffffff));
  if (const State* state = plant_.state()) response.state = state_publisher_.message(*state, present());
  return true;
}

/// Takes the ticks until then, and at the end one that is none.
/// @return  why it has not come so far; else empty
std::string SimulatorNode::run_to(double time) {
  plant_.apply_command(Wall::now());
  while (clock_.next_time() <= time) {
    if (!goes_on()) return "the node shuts down";
    if (plant_.halted()) return plant_.halt();
    tick(Wall::now());
  }
  if (time > clock_.time()) {
    clock_.move_to(time);
    plant_.advance_to(time);
    state_publisher_.publish(present());
  }
  clock_publisher_.publish_at_once(present());
  return plant_.halt();
}

}  // namespace hybrid_sphere::ros_interface
