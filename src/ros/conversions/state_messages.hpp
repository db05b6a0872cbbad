#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <hybrid_sphere/SphereState.h>
#include <nav_msgs/Odometry.h>
#include <tf2_msgs/TFMessage.h>

#include "hybrid_sphere/simulation/records.hpp"
#include "hybrid_sphere/sphere/sphere.hpp"
#include "ros/node/parameters.hpp"

namespace hybrid_sphere::ros_interface {

/// The messages of every tick with their headers. Each is filled again and again: what a function returns is
/// valid until its next call.
class StateMessages {
 public:
  StateMessages(const Frames& frames, const Sphere& sphere);

  const geometry_msgs::PoseStamped& pose(const State& state, const ros::Time& stamp);
  const geometry_msgs::TwistStamped& twist(const State& state, const ros::Time& stamp);
  const nav_msgs::Odometry& odom(const State& state, const ros::Time& stamp);
  /// @param view_center  origin of the view's frame, which is sent if it has a name [m]
  const tf2_msgs::TFMessage& transform(const State& state, const ros::Time& stamp,
                                       const Vector3d& view_center = Vector3d::Zero());
  /// @param reaction  of the ground on the sphere, multipliers and normal force [N]
  const SphereState& state(const State& state, const Vector3d& reaction, const ros::Time& stamp);

 private:
  Sphere sphere_;
  geometry_msgs::PoseStamped pose_;
  geometry_msgs::TwistStamped twist_;
  nav_msgs::Odometry odom_;
  SphereState state_;
  tf2_msgs::TFMessage tf_;
};

}  // namespace hybrid_sphere::ros_interface
