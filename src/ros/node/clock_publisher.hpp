#pragma once

#include <ros/ros.h>

#include <chrono>

namespace hybrid_sphere::ros_interface {

/// /clock, if the node drives it: latched, so that a node that comes while time stands knows what time it is;
/// never the same time twice, and no more often than asked for but where time comes to stand.
class ClockPublisher {
 public:
  using Wall = std::chrono::steady_clock;

  /// @param publishes  false: nothing is advertised, nothing is sent
  /// @param rate       in wall time [Hz]
  ClockPublisher(ros::NodeHandle& node, bool publishes, double rate);

  /// At every tick.
  void publish(const ros::Time& stamp, Wall::time_point now);
  /// Where time comes to stand: the clock must not lag behind the stamps then.
  void publish_at_once(const ros::Time& stamp);

 private:
  std::chrono::nanoseconds period_;
  Wall::time_point due_{};
  ros::Time last_;
  ros::Publisher publisher_;
};

}  // namespace hybrid_sphere::ros_interface
