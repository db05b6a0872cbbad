#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <hybrid_sphere/ConstraintSwitch.h>
#include <hybrid_sphere/SetInitialState.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include <functional>
#include <vector>

#include "hybrid_sphere/ros/command.hpp"
#include "hybrid_sphere/ros/drop_log.hpp"
#include "hybrid_sphere/ros/map_server.hpp"
#include "hybrid_sphere/ros/parameters.hpp"
#include "hybrid_sphere/ros/sphere_markers.hpp"
#include "hybrid_sphere/ros/state_publisher.hpp"
#include "hybrid_sphere/ros/switch_log.hpp"
#include "hybrid_sphere/ros/tick_clock.hpp"
#include "hybrid_sphere/simulation/simulation.hpp"

namespace hybrid_sphere::ros_interface {

/// The simulation as a node: topics and services under its private names, /tf, and the loop that keeps steady
/// wall time. One thread simulates and handles what comes in between ticks, with the state of the last one;
/// maps have a thread of their own (map_server.hpp).
class SimulatorNode {
 public:
  explicit SimulatorNode(const Configuration& configuration);

  /// Takes each tick at its deadline, the first one at once, until ROS shuts down.
  void run();

 private:
  using Wall = TickClock::Wall;

  void advertise();
  void handle_callbacks_until(Wall::time_point deadline);
  void tick();
  void advance_to(double time);
  void set_command(Wall::time_point now);
  void pass(const Switch& event);
  void let_ground_act();
  void publish_markers(Wall::time_point now);

  MapServer::Exchange put_in_force(const std::shared_ptr<const Ground>& ground);
  void take_command(const geometry_msgs::WrenchStamped& message);
  bool set_initial_state(SetInitialState::Request& request, SetInitialState::Response& response);
  bool reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  void restart(const std::function<void()>& put_sphere);

  double rate_;  // [Hz]
  Frames frames_;
  scene::SphereBody body_;
  Simulation simulation_;
  Simulation::SwitchSink sink_;
  TickClock clock_;
  ros::NodeHandle node_{"~"};
  StatePublisher state_publisher_;
  SphereMarkers markers_;
  SwitchLog switch_log_;
  ConstraintSwitch switch_message_;
  Command command_;
  DropLog command_drops_{"cmd_wrench"};
  bool halted_ = false;  // the computation cannot go on; the last state is held
  bool new_marker_listener_ = false;
  Wall::time_point next_markers_;
  Wall::time_point next_ball_;

  ros::Publisher switch_publisher_;
  ros::Publisher markers_publisher_;
  ros::Subscriber command_subscriber_;
  std::vector<ros::ServiceServer> services_;
  MapServer map_server_;  // last: its thread uses the others
};

/// Reads the private parameters and runs the node.
/// @return  exit code: 0 shut down, 3 scene refused, 4 the computation could not go on
int run_simulator(int argc, char** argv);

}  // namespace hybrid_sphere::ros_interface
