#pragma once

#include <hybrid_sphere/GetState.h>
#include <hybrid_sphere/SystemSwitch.h>
#include <ros/ros.h>
#include <std_msgs/Float64MultiArray.h>

#include <memory>
#include <optional>

#include "ros/node/driven_node.hpp"
#include "ros/node/guarded_queue.hpp"
#include "ros/node/state_topic.hpp"
#include "ros/node/switch_log.hpp"
#include "ros/node/time_loop.hpp"
#include "ros/system/system_messages.hpp"
#include "ros/system/system_parameters.hpp"
#include "ros/system/system_plant.hpp"

namespace hybrid_sphere::ros_interface {

/// Any Lagrangian system as a node: topics and services under its private names, and /tf. One thread
/// simulates and handles what comes in between ticks (time_loop.hpp).
class SystemNode final : private DrivenNode {
 public:
  /// @param node  whose names are the private ones; its callback queue is left alone
  /// @throws std::invalid_argument  for a system that the engine refuses
  SystemNode(const ros::NodeHandle& node, const SystemConfiguration& configuration,
             std::shared_ptr<const SystemPlugin> system);

  /// @throws StampError  as TimeLoop::run
  void run() { time_.run(); }

 private:
  void pass(const mechanics::Switch& event);
  mechanics::ActiveSet struck(const mechanics::Switch& event) const;
  void take_input(const std_msgs::Float64MultiArray& message);
  bool get_state(GetState::Request& request, GetState::Response& response);
  template <class Response>
  void fill(const mechanics::State& state, Response& response);
  template <class Message, class Make>
  std::function<const Message*()> present(const Make& make);

  void publish_state(const ros::Time& stamp) override;
  void publish_markers(Wall::time_point now) override;
  bool is_watched() const override { return markers_publisher_.getNumSubscribers() != 0; }
  void apply_input(double clock) override { plant_.apply_input(clock); }
  bool input_waits() const override { return false; }
  void has_started_anew() override {}
  void show_standing(bool /*stands*/) override {}
  void describe(Step::Response& response) override;

  GuardedQueue queue_{[this](const std::string& reason) { time_.fail(reason); }};
  ros::NodeHandle node_;
  std::shared_ptr<const SystemPlugin> system_;
  SystemPlant plant_;
  TimeLoop time_;
  SystemMessages messages_;
  StateTopic<sensor_msgs::JointState> joints_;
  StateTopic<SystemState> state_;
  std::optional<StateTopic<tf2_msgs::TFMessage>> tf_;  // where there are bodies
  SwitchLog switch_log_;
  ros::Publisher switch_publisher_;
  ros::Publisher markers_publisher_;
  Wall::time_point next_markers_;
  ros::Subscriber input_subscriber_;
  ros::ServiceServer get_state_;
};

}  // namespace hybrid_sphere::ros_interface
