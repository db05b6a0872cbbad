#include "ros/node/clock_publisher.hpp"

#include <rosgraph_msgs/Clock.h>

#include <algorithm>

#include "ros/node/queues.hpp"

namespace hybrid_sphere::ros_interface {

ClockPublisher::ClockPublisher(ros::NodeHandle& node, bool publishes, double rate)
    : period_(std::chrono::round<std::chrono::nanoseconds>(std::chrono::duration<double>(1 / rate))) {
  if (publishes) publisher_ = node.advertise<rosgraph_msgs::Clock>("/clock", newest_only, true);
}

// The grid of what is due is kept as long as it is met, so that the rate is the one asked for.
void ClockPublisher::publish(const ros::Time& stamp, Wall::time_point now) {
  if (!publisher_ || now < due_) return;
  due_ = std::max(due_ + period_, now - period_ / 2);
  publish_at_once(stamp);
}

void ClockPublisher::publish_at_once(const ros::Time& stamp) {
  if (!publisher_ || !(stamp > last_)) return;
  last_ = stamp;
  rosgraph_msgs::Clock message;
  message.clock = stamp;
  publisher_.publish(message);
}

}  // namespace hybrid_sphere::ros_interface
