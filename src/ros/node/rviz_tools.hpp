#pragma once

#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <ros/ros.h>

#include <cstdint>
#include <functional>
#include <string>

#include "ros/node/drag_handle.hpp"
#include "ros/node/drop_log.hpp"
#include "ros/node/frame_transformer.hpp"
#include "ros/node/parameters.hpp"
#include "ros/node/plant.hpp"

namespace hybrid_sphere::ros_interface {

/// What rviz's tools do with the sphere: "2D Pose Estimate" (initialpose) puts it somewhere at rest, "Publish
/// Point" (clicked_point) kicks it towards a point, and a handle drags it while time stands. The two topics
/// are relative names in the namespace that the node is in. All of it happens in the thread of the node's
/// queue.
class RvizTools {
 public:
  /// What is left to the node.
  struct Actions {
    std::function<void(const scene::InitialState&)> place;  ///< puts the sphere there, and starts anew
    /// A change of the velocity [m/s]. @return why it was not done, else an empty text
    std::function<std::string(const Vector2d& change)> kick;
  };

  /// @param node   whose private names the simulator has, and whose queue is used
  /// @param kick   impulse of a kick over the mass [m/s]; 0: clicked_point is not listened to
  /// @param transformer, plant  have to live as long as this
  RvizTools(const ros::NodeHandle& node, const Frames& frames, FrameTransformer& transformer, double kick,
            Plant& plant, Actions actions);

  /// Shows the handle around the sphere while time stands, else takes it away; quick where nothing changes.
  void show_handle(bool time_stands);

 private:
  template <class Message>
  void take(const Message& message, DropLog& drops, std::function<void(const Eigen::Isometry3d&)> act);
  void take_pose(const geometry_msgs::PoseWithCovarianceStamped& message);
  void take_point(const geometry_msgs::PointStamped& message);
  void drag(const DragHandle::Feedback& feedback);

  FrameTransformer& transformer_;
  double kick_;
  std::uint64_t taken_ = 0;  // messages that have come
  Plant& plant_;
  Actions act_;
  DropLog pose_drops_{"initialpose"};
  DropLog point_drops_{"clicked_point"};
  DropLog drag_drops_{"handle"};
  ros::Subscriber pose_subscriber_;
  ros::Subscriber point_subscriber_;
  DragHandle handle_;
};

}  // namespace hybrid_sphere::ros_interface
