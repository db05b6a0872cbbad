#include "ros/node/rviz_tools.hpp"

#include <string>
#include <utility>

#include "ros/conversions/tool_messages.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

constexpr std::uint32_t tool_queue_size = 10;

/// A name in the namespace that the node is in.
std::string beside(const ros::NodeHandle& node, const std::string& name) {
  return ros::names::append(ros::names::parentNamespace(node.getNamespace()), name);
}

}  // namespace

RvizTools::RvizTools(const ros::NodeHandle& node, const Frames& frames, FrameTransformer& transformer,
                     double kick, Plant& plant, Actions actions)
    : transformer_(transformer),
      kick_(kick),
      plant_(plant),
      act_(std::move(actions)),
      handle_(node, frames, plant.sphere().radius(),
              [this](const DragHandle::Feedback& feedback) { drag(feedback); }) {
  ros::NodeHandle handle(node);
  pose_subscriber_ =
      handle.subscribe(beside(node, "initialpose"), tool_queue_size, &RvizTools::take_pose, this);
  if (kick_ > 0) {
    point_subscriber_ =
        handle.subscribe(beside(node, "clicked_point"), tool_queue_size, &RvizTools::take_point, this);
  }
}

void RvizTools::show_handle(bool time_stands) {
  if (!time_stands) {
    handle_.hide();
  } else if (const State* state = plant_.state()) {
    handle_.show(state->position);
  }
}

/// Acts with the transform from the message's frame, or counts why not.
template <class Message>
void RvizTools::take(const Message& message, DropLog& drops,
                     std::function<void(const Eigen::Isometry3d&)> act) {
  const auto guarded = [this, &drops, act = std::move(act),
                        index = ++taken_](const Eigen::Isometry3d& to_world) {
    if (index != taken_) return;  // a newer message has come while this one waited for its transform
    try {
      act(to_world);
    } catch (const scene::SceneError& error) {
      drops.add(error.what());
    }
  };
  transformer_.with_transform(message.header.frame_id, drops.topic() + ".header.frame_id", guarded,
                              [&drops](const std::string& reason) { drops.add(reason); });
}

void RvizTools::take_pose(const geometry_msgs::PoseWithCovarianceStamped& message) {
  take(message, pose_drops_, [this, message](const Eigen::Isometry3d& to_world) {
    act_.place(initial_state_from_pose(message, to_world, plant_.sphere().radius()));
  });
}

void RvizTools::take_point(const geometry_msgs::PointStamped& message) {
  take(message, point_drops_, [this, message](const Eigen::Isometry3d& to_world) {
    const State* state = plant_.state();
    const std::string refused =
        state == nullptr ? plant_.halt()
                         : act_.kick(kick_ * direction_to_point(message, to_world, state->position));
    if (!refused.empty()) point_drops_.add(refused);
  });
}

void RvizTools::drag(const DragHandle::Feedback& feedback) {
  take(feedback, drag_drops_, [this, feedback](const Eigen::Isometry3d& to_world) {
    const State* state = plant_.state();
    const Quaterniond orientation = state ? state->orientation : Quaterniond::Identity();
    act_.place(initial_state_from_drag(feedback, to_world, orientation));
  });
}

}  // namespace hybrid_sphere::ros_interface
