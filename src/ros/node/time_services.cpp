// What the loop is asked for between ticks.

#include <algorithm>

#include "ros/node/answer.hpp"
#include "ros/node/callback_queue_call.hpp"
#include "ros/node/time_loop.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::ros_interface {

void TimeLoop::advertise() {
  if (parameters_.clock == ClockMode::follow)
    followed_.emplace(node_, [this](const ros::Time& to) { clock_jumped_back(to); });
  services_ = {node_.advertiseService("reset", &TimeLoop::reset, this),
               node_.advertiseService("pause", &TimeLoop::pause, this),
               node_.advertiseService("step", &TimeLoop::step, this)};
}

bool TimeLoop::reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  return answer(plant_, response, [&] {
    stand();  // what has been reported already has earlier stamps
    plant_.reset();
    start_anew();
    return std::string();
  });
}

void TimeLoop::start_anew() {
  clock_.restart();
  show_initial_state();
}

void TimeLoop::show_initial_state() {
  step_.ended_by = "a new initial state";
  holds_ = false;
  owner_.has_started_anew();
  plant_.act_now();
  publish_where_it_stands();
}

void TimeLoop::act_at_once() {
  stand();
  clock_.distinguish();
  plant_.act_now();
  if (!clock_.runs()) publish_where_it_stands();
}

void TimeLoop::adjust(double rate, double real_time_factor) {
  const Wall::time_point now = tick_now();
  if (rate != clock_.rate()) {
    stand();  // the next tick is another one
    clock_.set_rate(rate, now, followed_.has_value());
  }
  if (followed_ && real_time_factor != 1)
    ROS_WARN("real_time_factor: %g is without effect, as time follows /clock", real_time_factor);
  if (!followed_ && real_time_factor != clock_.factor()) clock_.set_factor(real_time_factor, now);
}

bool TimeLoop::pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
  if (!has_begun_) {  // it has no time yet
    parameters_.paused = request.data;
    response.success = true;
    response.message = request.data ? "paused" : "running";
    return true;
  }
  const bool ran = clock_.runs();
  answer(plant_, response, [&] {
    // A controller that steps the plant asks for a pause after its command: the answer says that it was
    // taken.
    if (!ran && request.data) wait_for_input();
    change_pause(request.data);
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

void TimeLoop::change_pause(bool paused) {
  step_.ended_by = "~pause";
  waits_until_.reset();
  const bool was_under_way = plant_.under_way();
  stand();
  if (!paused) {
    let_time_pass();
    owner_.show_standing(false);  // what comes from a handle from now on is too late
  } else if (was_under_way) {
    clock_.stand();
    clock_.distinguish();
    publish_where_it_stands();
  } else {
    clock_.stand();
    clock_publisher_.publish_at_once(present());
  }
}

/// Handles what comes until no input waits for its transform.
void TimeLoop::wait_for_input() {
  post(queue_, [] {});  // so that the queue also calls what it has taken out together with this
  while (owner_.input_waits() && goes_on()) queue_.callAvailable(ros::WallDuration(0.01));
}

bool TimeLoop::step(Step::Request& request, Step::Response& response) {
  constexpr double longest = 1e9;  // [s]
  const std::uint64_t before = step_.switches;
  answer(plant_, response, [&]() -> std::string {
    if (!(request.duration > 0 && request.duration <= longest)) {
      return text::refusal("duration: " + text::shortest(request.duration),
                           "a number greater than 0, up to 1e9 [s]");
    }
    if (followed_) return "the simulation follows /clock: step whoever publishes that";
    if (clock_.runs()) return "the simulation is running: only a paused one takes steps";
    if (step_.is_on_its_way)
      return "another step is in progress: wait for its response, or end it with ~pause";
    return run_to(clock_.end_of_step(request.duration));
  });
  response.switches =
      static_cast<std::uint32_t>(std::min<std::uint64_t>(step_.switches - before, 0xffffffff));
  owner_.describe(response);
  return true;
}

std::string TimeLoop::why_step_ends() {
  if (!goes_on()) return "the node is shutting down";
  if (plant_.halted()) return plant_.halt();
  if (!step_.ended_by.empty()) return "the step was ended by " + step_.ended_by;
  return {};
}

/// Handles what comes while a step is on its way, as between ticks.
void TimeLoop::serve_during_step() {
  const ros::WallDuration moment(plant_.under_way() ? 0.005 : 0.0);
  queue_.callAvailable(moment);
  const Wall::time_point now = Wall::now();
  if (now >= status_publisher_.due()) status_publisher_.publish(now);
  plant_.collect();
}

/// Takes the ticks until then, and at the end one that is none. A callback of the queue calls this, and this
/// calls others.
/// @return  why it has not come so far; else empty
std::string TimeLoop::run_to(double time) {
  struct OnItsWay {
    bool& flag;
    explicit OnItsWay(bool& of) : flag(of) { flag = true; }
    ~OnItsWay() { flag = false; }
  } const on_its_way(step_.is_on_its_way);
  step_.ended_by.clear();
  post(queue_, [] {});  // so that the queue also calls what it has taken out together with this
  owner_.apply_input(input_clock(Wall::now()));
  while (clock_.next_time() <= time && why_step_ends().empty()) {
    if (!plant_.under_way()) tick(Wall::now());
    serve_during_step();
  }
  while (clock_.time() < time && why_step_ends().empty()) {
    const double from = clock_.time();
    clock_.move_to(time);
    if (plant_.advance_to(time)) {
      owner_.publish_state(present());
    } else {
      clock_.wait_at(std::clamp(plant_.time(), from, time));
      serve_during_step();
    }
  }
  clock_publisher_.publish_at_once(present());
  return why_step_ends();
}

}  // namespace hybrid_sphere::ros_interface
