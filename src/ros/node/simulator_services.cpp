// What the node is asked for between ticks.

#include "ros/node/answer.hpp"
#include "ros/node/simulator_node.hpp"

namespace hybrid_sphere::ros_interface {

MapServer::Exchange SimulatorNode::put_in_force(const std::shared_ptr<const Ground>& ground,
                                                const ErrorEstimate& estimate) {
  time_.stand();
  const bool halted = plant_.halted();
  plant_.set_ground(ground, estimate);
  if (halted) time_.resume();
  time_.act_at_once();
  return {time_.present(), view_.view().center().head<2>()};
}

void SimulatorNode::take_command(const geometry_msgs::WrenchStamped& message) {
  const auto refuse = [this](const std::string& reason) { plant_.command_drops().add(reason); };
  const auto take = [this, message, refuse, index = ++commands_](const Eigen::Isometry3d& to_world) {
    if (index != commands_) return;  // a newer one has come while this one waited for its transform
    try {
      plant_.take_command(wrench_from_message(message, to_world, body_));
    } catch (const scene::SceneError& error) {
      refuse(error.what());
    }
  };
  transformer_.with_transform(message.header.frame_id, "cmd_wrench.header.frame_id", take, refuse);
}

bool SimulatorNode::get_state(GetState::Request&, GetState::Response& response) {
  return answer(plant_, response, [&]() -> std::string {
    const State* state = plant_.state();
    if (state == nullptr) return plant_.halt();
    response.state = state_publisher_.message(*state, time_.present());
    return {};
  });
}

void SimulatorNode::put(const scene::InitialState& state) {
  time_.stand();
  const bool halted = plant_.halted();
  plant_.set_state(state);
  if (halted) time_.resume();
  time_.end_step("a new state");
  markers_.start_at(state.position);
  map_server_.keep_in_view(view_.follow({state.position.x(), state.position.y(), 0}).head<2>());
  time_.act_at_once();
}

std::string SimulatorNode::kick(const Vector2d& change) {
  time_.stand();
  if (plant_.halted()) return plant_.halt();
  plant_.kick(change);
  time_.act_at_once();
  return {};
}

void SimulatorNode::place(const scene::InitialState& state) {
  time_.stand();  // what has been reported already has earlier stamps
  plant_.set_initial_state(state);
  time_.start_anew();
}

void SimulatorNode::has_started_anew() {
  if (const State* state = plant_.state()) {
    view_.restart({state->position.x(), state->position.y(), 0});
    markers_.start_at(state->position);
    map_server_.keep_in_view(view_.view().center().head<2>());
  }
}

void SimulatorNode::describe(Step::Response& response) {
  if (const State* state = plant_.state()) response.state = state_publisher_.message(*state, time_.present());
}

void SimulatorNode::adjust(const Adjustable& values) {
  time_.adjust(values.rate, values.real_time_factor);
  plant_.set_accuracy(values.accuracy);
  markers_.set_style(values.markers);
}

}  // namespace hybrid_sphere::ros_interface
