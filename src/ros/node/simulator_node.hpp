#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <hybrid_sphere/ConstraintSwitch.h>
#include <hybrid_sphere/GetState.h>
#include <hybrid_sphere/Kick.h>
#include <hybrid_sphere/SetInitialState.h>
#include <hybrid_sphere/Step.h>
#include <ros/ros.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ros/markers/sphere_markers.hpp"
#include "ros/node/clock_publisher.hpp"
#include "ros/node/followed_clock.hpp"
#include "ros/node/frame_transformer.hpp"
#include "ros/node/guarded_queue.hpp"
#include "ros/node/map_server.hpp"
#include "ros/node/parameters.hpp"
#include "ros/node/plant.hpp"
#include "ros/node/reconfigure.hpp"
#include "ros/node/rviz_tools.hpp"
#include "ros/node/state_publisher.hpp"
#include "ros/node/status_publisher.hpp"
#include "ros/node/switch_log.hpp"
#include "ros/node/tick_clock.hpp"

namespace hybrid_sphere::ros_interface {

/// The simulation as a node: topics and services under its private names, /tf, and the loop that keeps steady
/// wall time. One thread simulates and handles what comes in between ticks, with the state of the last one;
/// a tick that takes long goes on in another one (plant.hpp), and what comes is handled meanwhile.
/// Maps have a thread of their own (map_server.hpp), and so has what asks the master (reconfigure.hpp,
/// drag_handle.hpp). Nothing is global: a process may hold several. No exception but that of run() leaves it:
/// any other one halts the plant.
class SimulatorNode {
 public:
  /// @param node  whose names are the simulator's private ones; its callback queue is left alone
  SimulatorNode(const ros::NodeHandle& node, const Configuration& configuration);

  /// Takes each tick at its deadline, the first one at once, until stop() or ROS shuts down.
  /// @throws StampError  past the last time that a stamp can tell
  void run();
  /// Any thread.
  void stop() { stops_ = true; }

 private:
  using Wall = TickClock::Wall;

  void advertise();
  void begin();
  bool goes_on() const { return !stops_ && ros::ok(); }
  void turn();
  void handle_callbacks_until_due();
  std::chrono::nanoseconds until_due() const;
  Wall::time_point tick_now() const { return followed_ ? followed_->point() : Wall::now(); }
  void clock_jumped_back(const ros::Time& to);
  void let_time_pass();
  void end_wait(Wall::time_point now);
  void keep_time(Wall::time_point now);
  void take_what_has_come(Wall::time_point now);
  bool tick(Wall::time_point now);
  bool go(double from, Wall::time_point now);
  void hold(Wall::time_point now);
  void stand();
  void fail(const std::string& what);
  template <class Function>
  void guarded(const Function& function);
  template <class Response, class Function>
  bool answer(Response& response, const Function& function);
  void publish(Wall::time_point now);
  void pass(const Switch& event);
  void publish_markers(Wall::time_point now);
  ros::Time present() const { return clock_.stamp(clock_.time()); }

  MapServer::Exchange put_in_force(const std::shared_ptr<const Ground>& ground,
                                   const ErrorEstimate& estimate);
  void take_command(const geometry_msgs::WrenchStamped& message);
  bool get_state(GetState::Request& request, GetState::Response& response);
  bool set_state(SetInitialState::Request& request, SetInitialState::Response& response);
  bool kick(Kick::Request& request, Kick::Response& response);
  bool set_initial_state(SetInitialState::Request& request, SetInitialState::Response& response);
  bool reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  bool step(Step::Request& request, Step::Response& response);
  std::string run_to(double time);
  std::string why_step_ends();
  void serve_during_step();
  void adjust(const Adjustable& values);
  void place(const scene::InitialState& state);
  void start_anew();
  void act_at_once();
  void publish_where_it_stands();

  std::atomic<bool> stops_{false};
  bool paused_;  // at the start
  bool has_begun_ = false;
  ClockMode clock_mode_;
  bool resets_on_jump_back_;
  std::optional<Wall::time_point> waits_until_;  // for a viewer: time begins then
  Wall::duration wait_for_viewer_;
  int realtime_priority_;
  Frames frames_;
  scene::SphereBody body_;
  GuardedQueue queue_{[this](const std::string& reason) { fail(reason); }};
  ros::NodeHandle node_;
  FrameTransformer transformer_;
  std::optional<FollowedClock> followed_;
  Plant plant_;
  TickClock clock_;
  ClockPublisher clock_publisher_;
  StatePublisher state_publisher_;
  StatusPublisher status_publisher_;
  SphereMarkers markers_;
  SwitchLog switch_log_;
  ConstraintSwitch switch_message_;
  std::uint64_t passed_ = 0;  // switches so far
  bool holds_ = false;        // time stands and stamps go on
  bool steps_ = false;        // a ~step is on its way
  std::string step_ended_by_;
  std::uint64_t commands_ = 0;  // that have come
  bool new_marker_listener_ = false;
  Wall::time_point next_markers_;
  Wall::time_point next_ball_;

  ros::Publisher switch_publisher_;
  ros::Publisher markers_publisher_;
  ros::Subscriber command_subscriber_;
  std::vector<ros::ServiceServer> services_;
  Reconfigure reconfigure_;
  RvizTools rviz_tools_;
  MapServer map_server_;  // last: its thread uses the others
};

/// The private parameters of a node.
/// @throws scene::SceneError  with the key's full path, the value and what is allowed
Configuration configuration_of(const ros::NodeHandle& node);

}  // namespace hybrid_sphere::ros_interface
