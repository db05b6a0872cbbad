#pragma once

#include <cmath>

/// The camera of the first view: rviz's orbit view from the south (yaw -pi/2), looking down at the ground.
namespace hybrid_sphere::ros_interface::camera {

constexpr double yaw = -1.5707963267948966;  ///< from the target to the camera, about z [rad]
constexpr double pitch = 0.95;               ///< below the horizon [rad]
constexpr double field_of_view =
    0.7853981633974483;  ///< of rviz, from the top to the bottom of the picture [rad]
/// Width over height of a narrow picture: a window of 4 : 3 with panels at one side.
constexpr double least_aspect = 1.25;
/// Height of the picture in a window of 1600 x 900, without title, menu and tools [pixels].
constexpr double picture_height = 760;
/// Least width of a body in this picture [pixels]: 25, and one more so that round-off never makes it fewer.
constexpr double least_body_width = 26;

/// Half the height of the picture at a depth of 1.
inline double half_height() { return std::tan(0.5 * field_of_view); }

}  // namespace hybrid_sphere::ros_interface::camera
