#pragma once

#include <ros/ros.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>

namespace hybrid_sphere::ros_interface {

/// A topic of every tick. Who comes while time stands gets the present state at once, alone.
template <class Message>
class StateTopic {
 public:
  /// @param present  the present state while time stands, valid until the next call, else null; called in the
  ///                 thread of the node's queue
  StateTopic(ros::NodeHandle& node, const std::string& name, std::function<const Message*()> present)
      : present_(std::move(present)) {
    constexpr std::uint32_t queue_size = 1000;  // a second at 1 kHz for a listener that hangs
    publisher_ = node.advertise<Message>(
        name, queue_size, [this](const ros::SingleSubscriberPublisher& listener) { greet(listener); },
        [this](const ros::SingleSubscriberPublisher&) { served_ -= std::min(served_, 1U); });
  }
  StateTopic(const StateTopic&) = delete;
  StateTopic& operator=(const StateTopic&) = delete;

  /// Whether anybody listens.
  bool wanted() const { return publisher_.getNumSubscribers() != 0; }

  /// @param make  makes the message, where somebody listens
  template <class Make>
  void publish(const Make& make) {
    served_ = publisher_.getNumSubscribers();
    if (served_ != 0) publisher_.publish(make());
  }
  /// There is nothing to send.
  void skip() { served_ = 0; }

 private:
  void greet(const ros::SingleSubscriberPublisher& listener) {
    // Who came before the last message was sent has it.
    if (served_ >= publisher_.getNumSubscribers()) return;
    if (const Message* message = present_()) listener.publish(*message);
  }

  std::function<const Message*()> present_;
  ros::Publisher publisher_;
  std::uint32_t served_ = 0;  // how many listeners had the last message
};

}  // namespace hybrid_sphere::ros_interface
