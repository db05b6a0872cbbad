#pragma once

#include <ros/ros.h>

#include <functional>
#include <optional>

#include "ros/conversions/state_messages.hpp"
#include "ros/node/parameters.hpp"
#include "ros/node/plant.hpp"

namespace hybrid_sphere::ros_interface {

/// The topics of every tick: ~pose, ~twist, ~odom, ~state and /tf. What nobody listens to is neither computed
/// nor sent. Who comes while time stands gets the present state at once, alone.
class StatePublisher {
 public:
  /// @param plant   has to live as long as this
  /// @param stands  stamp of the present state while time stands, else none; called in the thread of the
  ///                node's queue
  StatePublisher(ros::NodeHandle& node, const Frames& frames, Plant& plant,
                 std::function<std::optional<ros::Time>()> stands);

  /// The state that the plant has reached.
  /// @param stamp  later than that of the last call: a pair of frame and stamp is sent once
  void publish(const ros::Time& stamp);

  /// The state as a message.
  const SphereState& message(const State& state, const ros::Time& stamp);

 private:
  /// A topic, and how many listeners had its last message.
  struct Topic {
    ros::Publisher publisher;
    std::uint32_t served = 0;
    bool wanted() const { return publisher.getNumSubscribers() != 0; }
  };

  template <class Message>
  Topic advertise(ros::NodeHandle& node, const std::string& name, Topic StatePublisher::*topic,
                  const Message& (StatePublisher::*message)(const State&, const ros::Time&));
  template <class Message>
  void send(Topic& topic, const Message& (StatePublisher::*message)(const State&, const ros::Time&),
            const State& state, const ros::Time& stamp);

  const geometry_msgs::PoseStamped& pose(const State& state, const ros::Time& stamp);
  const geometry_msgs::TwistStamped& twist(const State& state, const ros::Time& stamp);
  const nav_msgs::Odometry& odom(const State& state, const ros::Time& stamp);
  const tf2_msgs::TFMessage& transform(const State& state, const ros::Time& stamp);

  Plant& plant_;
  std::function<std::optional<ros::Time>()> stands_;
  StateMessages messages_;
  Topic pose_topic_;
  Topic twist_topic_;
  Topic odom_topic_;
  Topic state_topic_;
  Topic tf_topic_;
};

}  // namespace hybrid_sphere::ros_interface
