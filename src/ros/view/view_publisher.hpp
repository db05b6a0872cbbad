#pragma once

#include <ros/ros.h>

#include <string>

#include "ros/view/followed_view.hpp"
#include "ros/view/scene_framing.hpp"

namespace hybrid_sphere::ros_interface {

/// The name of the frame that a node's view looks at: `NAME_view` for the node /NAME.
/// @param node  whose namespace is the node's name
std::string view_frame_of(const ros::NodeHandle& node);

/// Publishes how rviz shows a node, on the latched topic ~view, and keeps the point that the camera looks at.
class ViewPublisher {
 public:
  /// @param node  whose private name the topic has
  /// @param view_frame  frame that follows the body; the caller sends its transform
  /// @param map         all that is bounded on the map [m]; may be empty
  ViewPublisher(ros::NodeHandle& node, const std::string& world_frame, const std::string& view_frame,
                const Eigen::AlignedBox3d& map, const FramedBody& body);

  /// Follows the body to its present position [m]. @return the point that the camera looks at [m], world
  /// frame
  const Eigen::Vector3d& follow(const Eigen::Vector3d& body) {
    view_.follow(body);
    return view_.center();
  }
  /// Returns to the first view if the body is in the middle of its picture, else to one with the body in the
  /// middle.
  /// @param body  its position [m]
  void restart(const Eigen::Vector3d& body);

  const FollowedView& view() const { return view_; }

 private:
  Framing first_;
  FollowedView view_;
  ros::Publisher publisher_;
};

}  // namespace hybrid_sphere::ros_interface
