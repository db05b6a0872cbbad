#pragma once

#include <visualization_msgs/MarkerArray.h>

#include "hybrid_sphere/simulation/records.hpp"
#include "ros/node/parameters.hpp"

namespace hybrid_sphere::ros_interface {

/// The slip for rviz: an arrow from the contact point, a metre for each m/s; none where there is no
/// slip.
class SlipArrow {
 public:
  SlipArrow(const Frames& frames, double radius);

  /// Adds the arrow as it is now or, when the slip has ended, its deletion.
  /// @param all  also for a new listener, who may still show one of an earlier run
  void add_to(visualization_msgs::MarkerArray& markers, const State& state, bool all);

 private:
  visualization_msgs::Marker arrow_;
  double height_;
  bool shown_ = false;
};

}  // namespace hybrid_sphere::ros_interface
