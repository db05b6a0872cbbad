#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <string>

#include "ground/ground.hpp"
#include "ros/markers/picture.hpp"

namespace hybrid_sphere::ros_interface {

/// The ground for rviz: a colour for each law, the edges and the names of the regions, arrows where it moves.
/// Later regions lie over earlier ones by small steps of height below z = 0. The first marker deletes those
/// of the map before; a marker holds all regions of one law, so that a large map is few markers.
/// @param radius   of the sphere, which the steps must not exceed [m]
/// @param picture  what a camera shows: names are written there if there is room. Gets the names that are
/// written. If it
///                 is null, the camera shows the whole square.
visualization_msgs::MarkerArray surface_markers(const Ground& ground, const ViewSquare& view, double radius,
                                                const std::string& world_frame, Picture* picture = nullptr);

}  // namespace hybrid_sphere::ros_interface
