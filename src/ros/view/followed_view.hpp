#pragma once

#include <Eigen/Core>

namespace hybrid_sphere::ros_interface {

/// Offsets of a body from the point that a camera looks at, as parts of the camera's distance, along the axes
/// of the world (x to the right, y away from the camera, z up). With the pitch and the field of view of
/// camera.hpp, a body within `outer` is in the picture if its half width is at most 0.04 of the distance, see
/// FollowedViewTest.
struct DeadZone {
  static Eigen::Vector3d outer() { return {0.34, 0.26, 0.12}; }  ///< never exceeded
  static Eigen::Vector3d inner() { return 0.6 * outer(); }       ///< the view stands still within it
};

/// The point that a camera looks at. It stands still while the body is in the middle of the picture, and
/// moves with the body when that comes near the edge. Its velocity has no jumps, and the path does not depend
/// on how many steps it is followed in as long as the body does not turn back within a step.
class FollowedView {
 public:
  /// @param distance  of the camera from the point [m], > 0
  /// @param center    the point at the start [m], world frame
  /// @param body      position of the body [m], world frame; center is corrected so that the body is within
  /// outer
  FollowedView(double distance, const Eigen::Vector3d& center, const Eigen::Vector3d& body);

  /// Follows the body to its present position [m]. A jump out of the picture puts the body into the middle of
  /// it.
  void follow(const Eigen::Vector3d& body);

  const Eigen::Vector3d& center() const { return center_; }  ///< [m], world frame
  double distance() const { return distance_; }              ///< [m]

 private:
  double distance_;
  Eigen::Vector3d center_;
  Eigen::Vector3d body_;
};

}  // namespace hybrid_sphere::ros_interface
