#pragma once

#include <visualization_msgs/MarkerArray.h>

#include "ros/node/parameters.hpp"

namespace hybrid_sphere::ros_interface {

/// The sphere for rviz: a beach ball, whose pattern looks the same in no two orientations. It is fixed in
/// the sphere's frame, so that rviz moves it with every transform and it need not be sent again. A marker for
/// each colour: rviz shades only what has one colour.
/// @param radius  [m]
visualization_msgs::MarkerArray ball_markers(const Frames& frames, double radius);

}  // namespace hybrid_sphere::ros_interface
