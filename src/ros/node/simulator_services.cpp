// What the node is asked for between ticks.

#include <algorithm>
#include <cmath>

#include "ros/conversions/initial_state_message.hpp"
#include "ros/node/callback_queue_call.hpp"
#include "ros/node/simulator_node.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::ros_interface {

/// The one place where what a service's handler throws becomes an answer: what the caller has asked for is
/// refused, and whatever else goes wrong halts the plant, too.
template <class Response, class Function>
bool SimulatorNode::answer(Response& response, const Function& function) {
  try {
    response.message = function();
  } catch (const scene::SceneError& error) {
    response.message = error.what();
  } catch (const std::exception& error) {
    fail(error.what());
    response.message = plant_.halt();
  }
  response.success = response.message.empty();
  return true;
}

MapServer::Exchange SimulatorNode::put_in_force(const std::shared_ptr<const Ground>& ground,
                                                const ErrorEstimate& estimate) {
  stand();
  const bool halted = plant_.halted();
  plant_.set_ground(ground, estimate);
  if (halted) clock_.resume(plant_.time());
  act_at_once();
  const State* state = plant_.state();
  if (!state) return {present(), Vector2d::Zero(), Vector2d::Zero()};
  return {present(), state->position, state->twist.velocity};
}

void SimulatorNode::take_command(const geometry_msgs::WrenchStamped& message) {
  const auto refuse = [this](const std::string& reason) { plant_.command_drops().add(reason); };
  const auto take = [this, message, refuse, index = ++commands_](const Eigen::Isometry3d& to_world) {
    if (index != commands_) return;  // a newer one has come while this one waited for its transform
    try {
      plant_.take_command(wrench_from_message(message, to_world, body_), Wall::now());
    } catch (const scene::SceneError& error) {
      refuse(error.what());
    }
  };
  transformer_.with_transform(message.header.frame_id, "cmd_wrench.header.frame_id", take, refuse);
}

bool SimulatorNode::get_state(GetState::Request&, GetState::Response& response) {
  return answer(response, [&]() -> std::string {
    const State* state = plant_.state();
    if (state == nullptr) return plant_.halt();
    response.state = state_publisher_.message(*state, present());
    return {};
  });
}

bool SimulatorNode::set_state(SetInitialState::Request& request, SetInitialState::Response& response) {
  return answer(response, [&] {
    const scene::InitialState state = initial_state_from_message(request, plant_.sphere().radius());
    stand();
    const bool halted = plant_.halted();
    plant_.set_state(state);
    if (halted) clock_.resume(plant_.time());
    step_ended_by_ = "a new state";
    markers_.start_at(state.position);
    map_server_.keep_in_view(state.position);
    act_at_once();
    return std::string();
  });
}

bool SimulatorNode::kick(Kick::Request& request, Kick::Response& response) {
  return answer(response, [&]() -> std::string {
    const auto& impulse = request.impulse;
    if (impulse.z != 0) {
      return text::refusal("impulse.z: " + text::shortest(impulse.z),
                           "0: the sphere stays on the ground [N s]");
    }
    constexpr double largest = 1e15;  // [m/s]
    const Vector2d change = Vector2d(impulse.x, impulse.y) / plant_.sphere().mass();
    if (!(change.norm() <= largest)) {
      return text::refusal("impulse: (" + text::shortest(impulse.x) + ", " + text::shortest(impulse.y) + ")",
                           "finite impulses up to the mass times 1e15 m/s [N s]");
    }
    stand();
    if (plant_.halted()) return plant_.halt();
    plant_.kick(change);
    act_at_once();
    return {};
  });
}

bool SimulatorNode::set_initial_state(SetInitialState::Request& request,
                                      SetInitialState::Response& response) {
  return answer(response, [&] {
    place(initial_state_from_message(request, plant_.sphere().radius()));
    return std::string();
  });
}

bool SimulatorNode::reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  return answer(response, [&] {
    stand();  // what has been reported already has earlier stamps
    plant_.reset();
    start_anew();
    return std::string();
  });
}

void SimulatorNode::place(const scene::InitialState& state) {
  stand();  // what has been reported already has earlier stamps
  plant_.set_initial_state(state);
  start_anew();
}

/// After a new initial state.
void SimulatorNode::start_anew() {
  step_ended_by_ = "a new initial state";
  holds_ = false;
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
  stand();
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
  const Wall::time_point now = tick_now();
  if (values.rate != clock_.rate()) {
    stand();  // the next tick is another one
    clock_.set_rate(values.rate, now, followed_.has_value());
  }
  if (followed_ && values.real_time_factor != 1)
    ROS_WARN("real_time_factor: %g is without effect, as time follows /clock", values.real_time_factor);
  if (!followed_ && values.real_time_factor != clock_.factor())
    clock_.set_factor(values.real_time_factor, now);
  plant_.set_accuracy(values.accuracy);
  markers_.set_style(values.markers);
}

bool SimulatorNode::pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
  if (!has_begun_) {  // it has no time yet
    paused_ = request.data;
    response.success = true;
    response.message = request.data ? "paused" : "running";
    return true;
  }
  const bool ran = clock_.runs();
  answer(response, [&] {
    step_ended_by_ = "~pause";
    waits_until_.reset();
    const bool was_under_way = plant_.under_way();
    stand();
    if (!request.data) {
      let_time_pass();
      rviz_tools_.show_handle(false);  // what comes from it from now on is too late
    } else if (was_under_way) {
      clock_.stand();
      clock_.distinguish();
      publish_where_it_stands();
    } else {
      clock_.stand();
      clock_publisher_.publish_at_once(present());
    }
    return std::string();
  });
  if (!response.success) return true;
  if (request.data) {
    response.message = ran ? "paused" : "already paused";
  } else {
    response.message = ran ? "already running" : "running";
  }
  return true;
}

bool SimulatorNode::step(Step::Request& request, Step::Response& response) {
  constexpr double longest = 1e9;  // [s]
  const std::uint64_t passed_before = passed_;
  answer(response, [&]() -> std::string {
    if (!(request.duration > 0 && request.duration <= longest)) {
      return text::refusal("duration: " + text::shortest(request.duration),
                           "a number greater than 0, up to 1e9 [s]");
    }
    if (followed_) return "the simulation follows /clock: step whoever publishes that";
    if (clock_.runs()) return "the simulation is running: only a paused one takes steps";
    if (steps_) return "another step is in progress: wait for its response, or end it with ~pause";
    return run_to(clock_.end_of_step(request.duration));
  });
  response.switches =
      static_cast<std::uint32_t>(std::min<std::uint64_t>(passed_ - passed_before, 0xffffffff));
  if (const State* state = plant_.state()) response.state = state_publisher_.message(*state, present());
  return true;
}

std::string SimulatorNode::why_step_ends() {
  if (!goes_on()) return "the node is shutting down";
  if (plant_.halted()) return plant_.halt();
  if (!step_ended_by_.empty()) return "the step was ended by " + step_ended_by_;
  return {};
}

/// Handles what comes while a step is on its way, as between ticks.
void SimulatorNode::serve_during_step() {
  const ros::WallDuration moment(plant_.under_way() ? 0.005 : 0.0);
  queue_.callAvailable(moment);
  const Wall::time_point now = Wall::now();
  if (now >= status_publisher_.due()) status_publisher_.publish(now);
  plant_.collect();
}

/// Takes the ticks until then, and at the end one that is none. A callback of the queue calls this, and this
/// calls others.
/// @return  why it has not come so far; else empty
std::string SimulatorNode::run_to(double time) {
  struct OnItsWay {
    bool& flag;
    explicit OnItsWay(bool& of) : flag(of) { flag = true; }
    ~OnItsWay() { flag = false; }
  } const on_its_way(steps_);
  step_ended_by_.clear();
  post(queue_, [] {});  // so that the queue also calls what it has taken out together with this
  plant_.apply_command(Wall::now());
  while (clock_.next_time() <= time && why_step_ends().empty()) {
    if (!plant_.under_way()) tick(Wall::now());
    serve_during_step();
  }
  while (clock_.time() < time && why_step_ends().empty()) {
    const double from = clock_.time();
    clock_.move_to(time);
    if (plant_.advance_to(time)) {
      state_publisher_.publish(present());
    } else {
      clock_.wait_at(std::clamp(plant_.time(), from, time));
      serve_during_step();
    }
  }
  clock_publisher_.publish_at_once(present());
  return why_step_ends();
}

}  // namespace hybrid_sphere::ros_interface
