#pragma once

#include <ros/ros.h>

#include <functional>
#include <optional>

#include "ros/conversions/state_messages.hpp"
#include "ros/node/parameters.hpp"
#include "ros/node/plant.hpp"
#include "ros/node/state_topic.hpp"
#include "ros/view/view_publisher.hpp"

namespace hybrid_sphere::ros_interface {

/// The topics of every tick: ~pose, ~twist, ~odom, ~state and /tf. What nobody listens to is neither computed
/// nor sent. Who comes while time stands gets the present state at once, alone.
class StatePublisher {
 public:
  /// @param plant, view  have to live as long as this
  /// @param stands  stamp of the present state while time stands, else none; called in the thread of the
  ///                node's queue
  StatePublisher(ros::NodeHandle& node, const Frames& frames, Plant& plant, ViewPublisher& view,
                 std::function<std::optional<ros::Time>()> stands);

  /// The state that the plant has reached.
  /// @param stamp  later than that of the last call: a pair of frame and stamp is sent once
  void publish(const ros::Time& stamp);

  /// The state as a message.
  const SphereState& message(const State& state, const ros::Time& stamp);

 private:
  /// Makes a message of the present state while time stands.
  /// @param make  const Message& make(const State&, const ros::Time&)
  template <class Message, class Make>
  std::function<const Message*()> present(const Make& make);

  const tf2_msgs::TFMessage& transform(const State& state, const ros::Time& stamp);

  Plant& plant_;
  ViewPublisher& view_;
  std::function<std::optional<ros::Time>()> stands_;
  StateMessages messages_;
  StateTopic<geometry_msgs::PoseStamped> pose_;
  StateTopic<geometry_msgs::TwistStamped> twist_;
  StateTopic<nav_msgs::Odometry> odom_;
  StateTopic<SphereState> state_;
  StateTopic<tf2_msgs::TFMessage> tf_;
};

}  // namespace hybrid_sphere::ros_interface
