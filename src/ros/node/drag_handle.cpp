#include "ros/node/drag_handle.hpp"

#include <interactive_markers/interactive_marker_server.h>

#include <chrono>
#include <cmath>
#include <utility>

#include "ros/markers/marker_tools.hpp"
#include "ros/node/callback_queue_call.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

using visualization_msgs::InteractiveMarker;
using visualization_msgs::InteractiveMarkerControl;
using visualization_msgs::Marker;

const char* const name = "sphere";

}  // namespace

DragHandle::DragHandle(const ros::NodeHandle& node, const Frames& frames, double radius, Moved moved)
    : node_(node), frames_(frames), radius_(radius), moved_(std::move(moved)) {}

DragHandle::~DragHandle() = default;

/// A clear shell that the mouse can catch, and a disc on the ground that shows where it moves.
InteractiveMarker DragHandle::marker() const {
  InteractiveMarker marker;
  marker.header.frame_id = frames_.world;
  marker.name = name;
  marker.scale = static_cast<float>(4 * radius_);
  InteractiveMarkerControl control;
  control.name = "move";
  control.interaction_mode = InteractiveMarkerControl::MOVE_PLANE;
  control.orientation_mode = InteractiveMarkerControl::FIXED;
  // Its x axis is the normal of the plane: upright.
  control.orientation.w = control.orientation.y = std::sqrt(0.5);
  control.always_visible = true;
  control.markers.push_back(make_marker("", "", 0, Marker::SPHERE));
  Marker& shell = control.markers.back();
  shell.scale.x = shell.scale.y = shell.scale.z = 2.2 * radius_;
  shell.color = color(1, 0.75, 0.1, 0.2);
  control.markers.push_back(make_marker("", "", 1, Marker::CYLINDER));
  Marker& disc = control.markers.back();
  disc.scale.x = disc.scale.y = 4 * radius_;
  disc.scale.z = 0.04 * radius_;
  disc.pose.position.z = -0.97 * radius_;
  disc.color = color(1, 0.75, 0.1, 0.5);
  marker.controls.push_back(control);
  return marker;
}

bool DragHandle::is_advertised() {
  // A shutdown ends the wait for a master, too: its topics cannot be used then.
  if (server_) return !ros::isShuttingDown();
  if (!coming_.valid()) {
    coming_ = std::async(std::launch::async, [topics = node_.resolveName("handle")] {
      return std::make_unique<interactive_markers::InteractiveMarkerServer>(topics, "", true);
    });
  }
  if (coming_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
  server_ = coming_.get();
  return !ros::isShuttingDown();
}

void DragHandle::show(const Vector2d& position) {
  if (shown_ && !moved_by_hand_ && position == position_) return;
  if (!is_advertised()) return;
  geometry_msgs::Pose pose;
  pose.position = point(position.x(), position.y(), radius_);
  pose.orientation.w = 1;
  if (shown_) {
    server_->setPose(name, pose);
  } else {
    InteractiveMarker handle = marker();
    handle.pose = pose;
    ros::CallbackQueueInterface* queue = node_.getCallbackQueue();
    const auto hand_on = [this,
                          queue](const visualization_msgs::InteractiveMarkerFeedbackConstPtr& feedback) {
      post(*queue, [this, feedback] { take(*feedback); });
    };
    server_->insert(handle, hand_on, Feedback::POSE_UPDATE);
  }
  server_->applyChanges();
  shown_ = true;
  moved_by_hand_ = false;
  position_ = position;
}

void DragHandle::hide() {
  if (!std::exchange(shown_, false)) return;
  server_->erase(name);
  server_->applyChanges();
}

void DragHandle::take(const Feedback& feedback) {
  if (!shown_) return;  // it was on its way when time went on
  moved_by_hand_ = true;
  moved_(feedback);
}

}  // namespace hybrid_sphere::ros_interface
