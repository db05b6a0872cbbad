#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <hybrid_sphere/ConstraintSwitch.h>
#include <hybrid_sphere/GetState.h>
#include <hybrid_sphere/Step.h>
#include <ros/ros.h>

#include <cstdint>
#include <optional>
#include <string>

#include "ros/markers/sphere_markers.hpp"
#include "ros/node/driven_node.hpp"
#include "ros/node/frame_transformer.hpp"
#include "ros/node/guarded_queue.hpp"
#include "ros/node/map_server.hpp"
#include "ros/node/parameters.hpp"
#include "ros/node/plant.hpp"
#include "ros/node/reconfigure.hpp"
#include "ros/node/rviz_tools.hpp"
#include "ros/node/sphere_requests.hpp"
#include "ros/node/state_publisher.hpp"
#include "ros/node/switch_log.hpp"
#include "ros/node/time_loop.hpp"
#include "ros/view/view_publisher.hpp"

namespace hybrid_sphere::ros_interface {

/// The simulation as a node: topics and services under its private names, and /tf. One thread simulates and
/// handles what comes in between ticks (time_loop.hpp). Threads of their own have maps
/// (map_server.hpp), what may wait for a transform (sphere_requests.hpp) and what asks the master
/// (reconfigure.hpp, drag_handle.hpp). Nothing is global: a process may hold several.
class SimulatorNode final : private DrivenNode {
 public:
  /// @param node  whose names are the simulator's private ones; its callback queue is left alone
  SimulatorNode(const ros::NodeHandle& node, const Configuration& configuration);

  /// @throws StampError  as TimeLoop::run
  void run() { time_.run(); }
  /// Any thread.
  void stop() { time_.stop(); }

 private:
  void advertise();
  void pass(const Switch& event);

  void publish_state(const ros::Time& stamp) override { state_publisher_.publish(stamp); }
  void publish_markers(Wall::time_point now) override;
  bool is_watched() const override { return markers_publisher_.getNumSubscribers() != 0; }
  void apply_input(double clock) override { plant_.apply_command(clock); }
  bool input_waits() const override { return transformer_.waiting() > 0; }
  void has_started_anew() override;
  void show_standing(bool stands) override {
    if (rviz_tools_) rviz_tools_->show_handle(stands);
  }
  void describe(Step::Response& response) override;

  MapServer::Exchange put_in_force(const std::shared_ptr<const Ground>& ground,
                                   const ErrorEstimate& estimate);
  void take_command(const geometry_msgs::WrenchStamped& message);
  bool get_state(GetState::Request& request, GetState::Response& response);
  void adjust(const Adjustable& values);
  void place(const scene::InitialState& state);
  void put(const scene::InitialState& state);
  std::string kick(const Vector2d& change);

  Frames frames_;
  scene::SphereBody body_;
  GuardedQueue queue_{[this](const std::string& reason) { time_.fail(reason); }};
  ros::NodeHandle node_;
  FrameTransformer transformer_;
  Plant plant_;
  TimeLoop time_;
  ViewPublisher view_;
  StatePublisher state_publisher_;
  SphereMarkers markers_;
  SwitchLog switch_log_;
  ConstraintSwitch switch_message_;
  std::uint64_t commands_ = 0;  // that have come
  bool new_marker_listener_ = false;
  Wall::time_point next_markers_;
  Wall::time_point next_ball_;

  ros::Publisher switch_publisher_;
  ros::Publisher markers_publisher_;
  ros::Subscriber command_subscriber_;
  ros::ServiceServer state_service_;
  Reconfigure reconfigure_;
  std::optional<RvizTools> rviz_tools_;  // none where they are switched off
  MapServer map_server_;                 // its thread uses those above
  SphereRequests requests_;              // so does this one
};

/// The private parameters of a node over the scene in ~scene_file, if there is one. What is taken from the
/// file is written to the parameter server.
/// @throws scene::SceneError  with the key's full path, the value and what is allowed
Configuration configuration_of(const ros::NodeHandle& node);

}  // namespace hybrid_sphere::ros_interface
