#pragma once

#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>

#include <chrono>

namespace hybrid_sphere::ros_interface {

/// /clock, if the node drives it: latched, so that a node that comes while time stands knows what time it is;
/// never the same time twice, and no more often than asked for but where time comes to stand. Warns where
/// another node publishes /clock, too.
class ClockPublisher {
 public:
  using Wall = std::chrono::steady_clock;

  /// @param publishes  false: nothing is advertised, nothing is sent
  /// @param rate       at most, in wall time [Hz]; 0: at every tick
  ClockPublisher(ros::NodeHandle& node, bool publishes, double rate);

  /// At every tick.
  void publish(const ros::Time& stamp, Wall::time_point now);
  /// Where time comes to stand: the clock must not lag behind the stamps then.
  void publish_at_once(const ros::Time& stamp);

 private:
  void take(const ros::MessageEvent<const rosgraph_msgs::Clock>& event);

  std::chrono::nanoseconds period_;
  Wall::time_point due_{};
  ros::Time last_;
  ros::Publisher publisher_;
  ros::Subscriber watch_;  // for others that publish /clock, at the beginning
  Wall::time_point watch_end_;
};

}  // namespace hybrid_sphere::ros_interface
