#pragma once

#include <visualization_msgs/Marker.h>

#include <Eigen/Core>
#include <limits>
#include <string>

namespace hybrid_sphere::ros_interface {

/// The way that a body has come, for rviz: one colour where no constraint holds, another where one does.
class BodyTrail {
 public:
  /// @param width  of the line [m]
  BodyTrail(const std::string& world_frame, double width);

  /// A time before the last one begins a new trail. @param time  t [s]
  void add(double time, const Eigen::Vector3d& place, bool is_constrained);

  /// Whether there is a line.
  bool is_visible() const { return line_.points.size() > 1; }
  const visualization_msgs::Marker& marker() const { return line_; }

 private:
  visualization_msgs::Marker line_;
  double last_ = std::numeric_limits<double>::infinity();  // time [s]
};

}  // namespace hybrid_sphere::ros_interface
