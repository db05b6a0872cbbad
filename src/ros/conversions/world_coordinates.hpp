#pragma once

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Quaternion.h>
#include <geometry_msgs/Vector3.h>

#include <Eigen/Geometry>
#include <string>

#include "hybrid_sphere/scene/scene_error.hpp"

/// Converts quantities of messages to the world frame. `to_world` takes coordinates of the one to those of
/// the other; where it is the identity the numbers stay the same to the bit.
namespace hybrid_sphere::ros_interface {

Eigen::Vector3d point_in_world(const geometry_msgs::Point& point, const Eigen::Isometry3d& to_world);

Eigen::Vector3d vector_in_world(const geometry_msgs::Vector3& vector, const Eigen::Isometry3d& to_world);

/// Converts a vector along the ground. Its third coordinate must be 0, up to round-off after a turn.
/// @param path, allowed  of the third coordinate, for the error
/// @throws scene::SceneError
Eigen::Vector2d horizontal_in_world(const geometry_msgs::Vector3& vector, const Eigen::Isometry3d& to_world,
                                    const std::string& path, const std::string& allowed);

/// Height of the sphere's centre, 0 or the radius [m]: after a transform but for rounding.
/// @param path  for the error
/// @throws scene::SceneError
void check_height(double height, const Eigen::Isometry3d& to_world, double radius, const std::string& path);

/// Four zeros are the identity. Not normalized.
Eigen::Quaterniond orientation_in_world(const geometry_msgs::Quaternion& orientation,
                                        const Eigen::Isometry3d& to_world);

}  // namespace hybrid_sphere::ros_interface
