#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <hybrid_sphere/SphereState.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <tf2_msgs/TFMessage.h>

#include "hybrid_sphere/ros/parameters.hpp"
#include "hybrid_sphere/simulation/simulation.hpp"

namespace hybrid_sphere::ros_interface {

/// The topics of every tick: ~pose, ~twist, ~odom, ~state and /tf. What nobody listens to is neither computed
/// nor sent.
class StatePublisher {
 public:
  StatePublisher(ros::NodeHandle& node, const Frames& frames, const Sphere& sphere);

  bool has_listeners() const;

  /// The state that the simulation has reached.
  /// @param stamp  later than that of the last call: a pair of frame and stamp is sent once
  void publish(Simulation& simulation, const ros::Time& stamp);

 private:
  Sphere sphere_;
  ros::Publisher pose_publisher_;
  ros::Publisher twist_publisher_;
  ros::Publisher odom_publisher_;
  ros::Publisher state_publisher_;
  ros::Publisher tf_publisher_;
  geometry_msgs::PoseStamped pose_;
  geometry_msgs::TwistStamped twist_;
  nav_msgs::Odometry odom_;
  SphereState state_;
  tf2_msgs::TFMessage tf_;
};

}  // namespace hybrid_sphere::ros_interface
