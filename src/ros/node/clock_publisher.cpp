#include "ros/node/clock_publisher.hpp"

#include <algorithm>

#include "ros/node/publish_latched.hpp"
#include "ros/node/queues.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

// Whoever comes second hears the other one in its first seconds.
constexpr std::chrono::seconds watch_time(5);

std::chrono::nanoseconds period_of(double rate) {
  using Seconds = std::chrono::duration<double>;
  return rate == 0 ? std::chrono::nanoseconds::zero()
                   : std::chrono::round<std::chrono::nanoseconds>(Seconds(1 / rate));
}

}  // namespace

ClockPublisher::ClockPublisher(ros::NodeHandle& node, bool publishes, double rate)
    : period_(period_of(rate)), watch_end_(Wall::now() + watch_time) {
  if (!publishes) return;
  publisher_ = node.advertise<rosgraph_msgs::Clock>("/clock", newest_only, true);
  watch_ = node.subscribe("/clock", newest_only, &ClockPublisher::take, this);
}

void ClockPublisher::take(const ros::MessageEvent<const rosgraph_msgs::Clock>& event) {
  const std::string& other = event.getPublisherName();
  if (other == ros::this_node::getName()) return;
  ROS_WARN(
      "/clock is published by %s, too: other nodes get two times; set ~clock to `follow` or `own` in all but "
      "one",
      other.c_str());
  watch_.shutdown();
}

// The grid of what is due is kept as long as it is met, so that the rate is the one asked for.
void ClockPublisher::publish(const ros::Time& stamp, Wall::time_point now) {
  if (!publisher_ || now < due_) return;
  if (watch_ && now > watch_end_) watch_.shutdown();
  due_ = std::max(due_ + period_, now - period_ / 2);
  publish_at_once(stamp);
}

void ClockPublisher::publish_at_once(const ros::Time& stamp) {
  if (!publisher_ || !(stamp > last_)) return;
  last_ = stamp;
  rosgraph_msgs::Clock message;
  message.clock = stamp;
  publish_latched(publisher_, message);
}

}  // namespace hybrid_sphere::ros_interface
