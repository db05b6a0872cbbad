#include "ros/conversions/planar_transform.hpp"

#include <cmath>

#include "hybrid_sphere/scene/scene_error.hpp"
#include "scene/tree.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

using scene::SceneError;
using scene::Tree;

constexpr double slack = 1e-9;  // of what others have computed [1], [m]

}  // namespace

PlanarTransform PlanarTransform::from(const Eigen::Isometry3d& transform, const std::string& path) {
  const Eigen::Matrix3d axes = transform.linear();
  const bool is_upright = std::abs(axes(0, 2)) <= slack && std::abs(axes(1, 2)) <= slack && axes(2, 2) > 0;
  if (!is_upright || std::abs(transform.translation().z()) > slack) {
    throw SceneError(path, "a frame that is tilted, or not on the ground",
                     "frames on the ground with a vertical z axis");
  }
  const double length = std::hypot(axes(0, 0), axes(1, 0));
  return {axes(0, 0) / length, axes(1, 0) / length, transform.translation().head<2>()};
}

PlanarTransform PlanarTransform::from(const geometry_msgs::Pose& pose, const std::string& path) {
  const auto& q = pose.orientation;
  const Vector2d shift(pose.position.x, pose.position.y);
  if (!(pose.position.z == 0)) {
    throw SceneError(path + ".position[2]", Tree(pose.position.z).describe(), "0: the ground is flat");
  }
  const double square = q.z * q.z + q.w * q.w;
  constexpr double rough = 0.01;  // as of the orientation of an initial state
  const bool is_given = square != 0 || q.x != 0 || q.y != 0;
  if (is_given && !(q.x == 0 && q.y == 0 && std::abs(std::sqrt(square) - 1) <= rough)) {
    throw SceneError(path + ".orientation", Tree(Tree::List{q.x, q.y, q.z, q.w}).describe(),
                     "a turn about z, [0, 0, sin(a/2), cos(a/2)], or four zeros: the ground is flat");
  }
  if (!is_given || q.z == 0) return {1, 0, shift};
  return {(q.w * q.w - q.z * q.z) / square, 2 * q.w * q.z / square, shift};
}

PlanarTransform PlanarTransform::after(const PlanarTransform& first) const {
  const Vector2d axis = direction({first.cosine_, first.sine_});
  return {axis.x(), axis.y(), point(first.shift_)};
}

}  // namespace hybrid_sphere::ros_interface
