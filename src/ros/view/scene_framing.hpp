#pragma once

#include <Eigen/Geometry>

namespace hybrid_sphere::ros_interface {

/// The target of a camera, and its distance.
struct Framing {
  Eigen::Vector3d center;  ///< [m], world frame
  double distance;         ///< of the camera from the centre [m]
};

/// A body at the start of the motion.
struct FramedBody {
  Eigen::Vector3d position;  ///< [m], world frame
  Eigen::Vector3d velocity;  ///< [m/s], world frame
  double half_width;         ///< half of its width in the picture [m], > 0
};

/// Frames a box from the direction of the camera (camera.hpp).
Framing frame_box(const Eigen::AlignedBox3d& box);

/// Frames the map and the way of the next seconds, as if the body kept its velocity. The camera is not
/// farther than the least width of a body in the picture allows. Then the picture shows the part around the
/// body.
/// @param map  all that is bounded on the map [m]; may be empty
Framing first_framing(const Eigen::AlignedBox3d& map, const FramedBody& body);

/// Frames the map and the first framing's centre, from at least its distance.
Framing whole_framing(const Eigen::AlignedBox3d& map, const FramedBody& body, const Framing& first);

}  // namespace hybrid_sphere::ros_interface
