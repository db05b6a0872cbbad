#include "ros/node/rviz_tools.hpp"

#include <string>
#include <utility>

#include "ros/conversions/tool_messages.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

constexpr std::uint32_t queue_size = 10;

/// A name in the namespace that the node is in.
std::string beside(const ros::NodeHandle& node, const std::string& name) {
  return ros::names::append(ros::names::parentNamespace(node.getNamespace()), name);
}

}  // namespace

RvizTools::RvizTools(const ros::NodeHandle& node, const Frames& frames, double kick, Plant& plant,
                     Actions actions)
    : frames_(frames),
      kick_(kick),
      plant_(plant),
      act_(std::move(actions)),
      handle_(node, frames, plant.sphere().radius(),
              [this](const DragHandle::Feedback& feedback) { drag(feedback); }) {
  ros::NodeHandle handle(node);
  pose_subscriber_ = handle.subscribe(beside(node, "initialpose"), queue_size, &RvizTools::take_pose, this);
  if (kick_ > 0) {
    point_subscriber_ =
        handle.subscribe(beside(node, "clicked_point"), queue_size, &RvizTools::take_point, this);
  }
}

void RvizTools::show_handle(bool time_stands) {
  if (!time_stands) {
    handle_.hide();
  } else if (const State* state = plant_.state()) {
    handle_.show(state->position);
  }
}

void RvizTools::take_pose(const geometry_msgs::PoseWithCovarianceStamped& message) {
  try {
    act_.place(initial_state_from_pose(message, frames_.world, plant_.sphere().radius()));
  } catch (const scene::SceneError& error) {
    pose_drops_.add(error.what());
  }
}

void RvizTools::take_point(const geometry_msgs::PointStamped& message) {
  const State* state = plant_.state();
  if (state == nullptr || plant_.halted()) {
    point_drops_.add(plant_.halt());
    return;
  }
  try {
    plant_.kick(kick_ * direction_to_point(message, frames_.world, state->position));
  } catch (const scene::SceneError& error) {
    point_drops_.add(error.what());
    return;
  }
  act_.kicked();
}

void RvizTools::drag(const DragHandle::Feedback& feedback) {
  const State* state = plant_.state();
  const Quaterniond orientation = state ? state->orientation : Quaterniond::Identity();
  try {
    act_.place(initial_state_from_drag(feedback, frames_.world, orientation));
  } catch (const scene::SceneError& error) {
    drag_drops_.add(error.what());
  }
}

}  // namespace hybrid_sphere::ros_interface
