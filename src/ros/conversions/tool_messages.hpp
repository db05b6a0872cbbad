#pragma once

#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <visualization_msgs/InteractiveMarkerFeedback.h>

#include <Eigen/Geometry>

#include "hybrid_sphere/scene/scene.hpp"

/// What rviz's tools send, as what it means for the sphere. Stamps, frames and covariances are not looked at.
/// `to_world` takes coordinates of the message's frame to those of the world frame.
namespace hybrid_sphere::ros_interface {

/// "2D Pose Estimate": the sphere at rest with that place and orientation, validated as a scene's
/// initial_state; the height of the centre is 0 or the radius.
/// @param radius  of the sphere [m]
/// @throws scene::SceneError  with the path, the value and what is allowed
scene::InitialState initial_state_from_pose(const geometry_msgs::PoseWithCovarianceStamped& message,
                                            const Eigen::Isometry3d& to_world, double radius);

/// The interactive marker: the sphere at rest over that place. Height and orientation of the marker are not
/// looked at: rviz has them in single precision.
/// @param orientation  that the sphere keeps
/// @throws scene::SceneError  with the path, the value and what is allowed
scene::InitialState initial_state_from_drag(const visualization_msgs::InteractiveMarkerFeedback& message,
                                            const Eigen::Isometry3d& to_world,
                                            const Quaterniond& orientation);

/// "Publish Point": unit vector from the centre of the sphere to the place over or under the point.
/// @param center  [m]
/// @throws scene::SceneError  with the path, the value and what is allowed; also for the centre itself
Vector2d direction_to_point(const geometry_msgs::PointStamped& message, const Eigen::Isometry3d& to_world,
                            const Vector2d& center);

}  // namespace hybrid_sphere::ros_interface
