#include "ros/node/followed_clock.hpp"

#include <utility>

namespace hybrid_sphere::ros_interface {

FollowedClock::FollowedClock(ros::NodeHandle& node, std::function<void(const ros::Time&)> jumped_back)
    : jumped_back_(std::move(jumped_back)) {
  constexpr std::uint32_t few = 10;  // the time that counts is the last one
  subscriber_ = node.subscribe("/clock", few, &FollowedClock::take, this, ros::TransportHints().tcpNoDelay());
}

void FollowedClock::take(const rosgraph_msgs::Clock& message) {
  const ros::Time before = std::exchange(now_, message.clock);
  if (std::exchange(has_begun_, true) && now_ < before) jumped_back_(now_);
}

}  // namespace hybrid_sphere::ros_interface
