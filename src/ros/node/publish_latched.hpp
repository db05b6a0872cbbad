#pragma once

#include <cstdint>

namespace hybrid_sphere::ros_interface {

/// Publishes a message on a latched topic, so that whoever subscribes has it. A publisher of roscpp 1.15
/// keeps a message for later subscribers only after it has sent it to the present ones: a subscriber that
/// connects in between gets nothing. If one has come meanwhile, the message is sent again; it may reach some
/// twice.
/// @param publisher  a ros::Publisher that latches
template <typename Publisher, typename Message>
void publish_latched(const Publisher& publisher, const Message& message) {
  const std::uint32_t subscribers = publisher.getNumSubscribers();
  publisher.publish(message);
  if (publisher.getNumSubscribers() > subscribers) publisher.publish(message);
}

}  // namespace hybrid_sphere::ros_interface
