#pragma once

#include <ros/node_handle.h>
#include <visualization_msgs/InteractiveMarker.h>
#include <visualization_msgs/InteractiveMarkerFeedback.h>

#include <functional>
#include <future>
#include <memory>

#include "hybrid_sphere/sphere/twist.hpp"
#include "ros/node/parameters.hpp"

namespace interactive_markers {
class InteractiveMarkerServer;
}

namespace hybrid_sphere::ros_interface {

/// An interactive marker around the sphere that is dragged over the ground, on ~handle/update and
/// ~handle/feedback. Its server has a thread of its own, that of the library, which only hands on what comes;
/// all functions here are called in the thread of the node's queue.
class DragHandle {
 public:
  using Feedback = visualization_msgs::InteractiveMarkerFeedback;
  using Moved = std::function<void(const Feedback&)>;

  /// Nothing is advertised before it is to be shown for the first time; then another thread does it, as that
  /// takes as long as there is no master.
  /// @param node   whose private name it has, and in whose queue's thread it calls
  /// @param moved  called for each place to which it is dragged
  DragHandle(const ros::NodeHandle& node, const Frames& frames, double radius, Moved moved);
  ~DragHandle();
  DragHandle(const DragHandle&) = delete;
  DragHandle& operator=(const DragHandle&) = delete;

  /// Shows it there; quick where it is already. Does nothing as long as it is being advertised: to be called
  /// again and again.
  /// @param position  of the centre of the sphere [m]
  void show(const Vector2d& position);
  void hide();

 private:
  /// Has it advertised where it is not yet; does not wait.
  bool is_advertised();
  visualization_msgs::InteractiveMarker marker() const;
  void take(const Feedback& feedback);

  ros::NodeHandle node_;
  Frames frames_;
  double radius_;
  Moved moved_;
  bool shown_ = false;
  bool moved_by_hand_ = false;  // the server takes it to be elsewhere
  Vector2d position_ = Vector2d::Zero();
  std::unique_ptr<interactive_markers::InteractiveMarkerServer> server_;
  std::future<std::unique_ptr<interactive_markers::InteractiveMarkerServer>> coming_;
};

}  // namespace hybrid_sphere::ros_interface
