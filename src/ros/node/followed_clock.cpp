#include "ros/node/followed_clock.hpp"

#include <cmath>
#include <utility>

#include "text/refusal.hpp"

namespace hybrid_sphere::ros_interface {

FollowedClock::FollowedClock(ros::NodeHandle& node, std::function<void(const ros::Time&)> jumped_back)
    : jumped_back_(std::move(jumped_back)) {
  constexpr std::uint32_t few = 10;  // the time that counts is the last one
  subscriber_ = node.subscribe("/clock", few, &FollowedClock::take, this, ros::TransportHints().tcpNoDelay());
}

void FollowedClock::take(const ros::MessageEvent<const rosgraph_msgs::Clock>& event) {
  constexpr std::chrono::seconds patience(1);
  const Wall::time_point wall = Wall::now();
  const std::string& source = event.getPublisherName();
  if (has_begun_ && source != source_ && wall < heard_ + patience) {
    drops_.add("it is published by " + source + ", too, while " + source_ + " is followed");
    return;
  }
  source_ = source;
  heard_ = wall;
  const ros::Time told = event.getMessage()->clock;
  const double back = has_begun_ && told < now_ ? (now_ - told).toSec() : 0;
  if (back > 0 && back <= largest_step_back) {
    const double milliseconds = std::round(back * 1e4) / 10;
    drops_.add(source_ + " steps back by " + text::shortest(milliseconds) +
               " ms: the time is held (does a bag that is played with --clock hold /clock, too?)");
    return;
  }
  now_ = told;
  has_begun_ = true;
  if (back > 0) jumped_back_(now_);
}

}  // namespace hybrid_sphere::ros_interface
