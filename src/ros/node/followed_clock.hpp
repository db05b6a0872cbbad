#pragma once

#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>

#include <chrono>
#include <functional>
#include <string>

#include "ros/node/drop_log.hpp"
#include "ros/node/tick_clock.hpp"

namespace hybrid_sphere::ros_interface {

/// Somebody else's /clock as the time that ticks follow; in the thread of the node's queue. Where several
/// publish it, one of them is followed as long as it tells a time at least once a second of wall time.
class FollowedClock {
 public:
  /// How far the time that is told may step back without a jump: it is held then [s]. Two clocks of one
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
  Wall::time_point heard_;  // when it told a time last
  DropLog drops_{"/clock"};
  ros::Subscriber subscriber_;
};

}  // namespace hybrid_sphere::ros_interface
