#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>

#include <cstdint>

namespace hybrid_sphere::ros_interface {

/// Queue size of a subscriber that reads only the latest message.
constexpr std::uint32_t newest_only = 1;

/// Returns the handle, whose callbacks go to `queue` from now on.
inline ros::NodeHandle with_queue(ros::NodeHandle node, ros::CallbackQueue& queue) {
  node.setCallbackQueue(&queue);
  return node;
}

}  // namespace hybrid_sphere::ros_interface
