#pragma once

#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>

#include <chrono>
#include <functional>
#include <string>

#include "ros/node/drop_log.hpp"
#include "ros/node/tick_clock.hpp"

namespace hybrid_sphere::ros_interface {

/// Somebody else's /clock as the time that ticks follow; in the thread of the node's queue. If several
/// publish it, the node follows one of them until that one has been silent for a second of wall time.
class FollowedClock {
 public:
  /// A larger step back is a jump; at a smaller one the time is held [s]. Two clocks of one
  /// `rosbag play --clock` disagree by less.
  static constexpr double largest_step_back = 0.25;

  /// @param jumped_back  called with a time that is earlier than the one before by more than that
  FollowedClock(ros::NodeHandle& node, std::function<void(const ros::Time&)> jumped_back);

  /// Whether it has told a time.
  bool has_begun() const { return has_begun_; }
  const ros::Time& now() const { return now_; }
  /// The same on the scale of TickClock's times.
  TickClock::Wall::time_point point() const {
    return TickClock::Wall::time_point(std::chrono::nanoseconds(now_.toNSec()));
  }

 private:
  using Wall = std::chrono::steady_clock;

  void take(const ros::MessageEvent<const rosgraph_msgs::Clock>& event);

  std::function<void(const ros::Time&)> jumped_back_;
  ros::Time now_;
  bool has_begun_ = false;
  std::string source_;      // name of the node that is followed
  Wall::time_point heard_;  // when its last message came
  DropLog drops_{"/clock"};
  ros::Subscriber subscriber_;
};

}  // namespace hybrid_sphere::ros_interface
