#pragma once

#include <geometry_msgs/Pose.h>

#include <string>

#include <Eigen/Geometry>

#include "hybrid_sphere/scene/scene.hpp"

namespace hybrid_sphere::ros_interface {

/// Coordinates on the ground of one frame as those of another: a turn about the vertical and a shift.
class PlanarTransform {
 public:
  PlanarTransform() = default;
  PlanarTransform(double cosine, double sine, const Vector2d& shift)
      : cosine_(cosine), sine_(sine), shift_(shift) {}

  /// Of a frame whose z axis is vertical, and whose origin lies on the ground.
  /// @param path  of the frame, in error messages
  /// @throws scene::SceneError  for any other frame
  static PlanarTransform from(const Eigen::Isometry3d& transform, const std::string& path);
  /// Of a pose on the ground; four zeros are no rotation.
  /// @throws scene::SceneError  for one that is turned about another axis, or does not lie on the ground
  static PlanarTransform from(const geometry_msgs::Pose& pose, const std::string& path);

  bool turns() const { return sine_ != 0 || cosine_ != 1; }
  Vector2d direction(const Vector2d& v) const {
    return turns() ? Vector2d(cosine_ * v.x() - sine_ * v.y(), sine_ * v.x() + cosine_ * v.y()) : v;
  }
  Vector2d point(const Vector2d& p) const { return direction(p) + shift_; }
  /// First the other one, then this one.
  PlanarTransform after(const PlanarTransform& first) const;
  const Vector2d& shift() const { return shift_; }

 private:
  double cosine_ = 1;
  double sine_ = 0;
  Vector2d shift_ = Vector2d::Zero();
};

}  // namespace hybrid_sphere::ros_interface
