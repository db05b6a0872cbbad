#pragma once

#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>

#include <functional>

#include "ros/node/tick_clock.hpp"

namespace hybrid_sphere::ros_interface {

/// Somebody else's /clock as the time that ticks follow; in the thread of the node's queue.
class FollowedClock {
 public:
  /// @param jumped_back  called with a time earlier than the one before
  FollowedClock(ros::NodeHandle& node, std::function<void(const ros::Time&)> jumped_back);

  /// Whether it has told a time.
  bool has_begun() const { return has_begun_; }
  const ros::Time& now() const { return now_; }
  /// The same on the scale of TickClock's times.
  TickClock::Wall::time_point point() const {
    return TickClock::Wall::time_point(std::chrono::nanoseconds(now_.toNSec()));
  }

 private:
  void take(const rosgraph_msgs::Clock& message);

  std::function<void(const ros::Time&)> jumped_back_;
  ros::Time now_;
  bool has_begun_ = false;
  ros::Subscriber subscriber_;
};

}  // namespace hybrid_sphere::ros_interface
