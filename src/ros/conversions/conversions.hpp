#pragma once

#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Transform.h>
#include <geometry_msgs/Twist.h>
#include <hybrid_sphere/ConstraintSwitch.h>
#include <hybrid_sphere/SphereState.h>

#include "hybrid_sphere/simulation/records.hpp"
#include "hybrid_sphere/sphere/sphere.hpp"

/// Records of the simulation as messages. Headers are left to the caller. What is filled keeps its memory, so
/// that a message that is filled again and again does not allocate.
namespace hybrid_sphere::ros_interface {

/// @param radius  height of the centre [m]
void fill(const State& state, double radius, geometry_msgs::Pose& pose);
void fill(const State& state, double radius, geometry_msgs::Transform& transform);

/// A frame that is not rotated. @param origin  [m]
void fill(const Vector3d& origin, geometry_msgs::Transform& transform);

/// On the fixed axes of the world frame.
void fill(const Twist& twist, geometry_msgs::Twist& message);

/// On the axes of the sphere's own frame.
void fill_in_sphere_frame(const State& state, geometry_msgs::Twist& message);

/// @param reaction  of the ground on the sphere, multipliers and normal force [N]
void fill(const State& state, const Vector3d& reaction, const Sphere& sphere, SphereState& message);

void fill(const Switch& event, double radius, ConstraintSwitch& message);

}  // namespace hybrid_sphere::ros_interface
