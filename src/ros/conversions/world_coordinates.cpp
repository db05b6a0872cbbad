#include "ros/conversions/world_coordinates.hpp"

#include <cmath>

#include "scene/tree.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

using scene::SceneError;
using scene::Tree;

bool is_identity(const Eigen::Isometry3d& transform) {
  return transform.isApprox(Eigen::Isometry3d::Identity(), 0);
}

}  // namespace

Eigen::Vector3d point_in_world(const geometry_msgs::Point& p, const Eigen::Isometry3d& to_world) {
  const Eigen::Vector3d point(p.x, p.y, p.z);
  return is_identity(to_world) ? point : Eigen::Vector3d(to_world * point);
}

Eigen::Vector3d vector_in_world(const geometry_msgs::Vector3& v, const Eigen::Isometry3d& to_world) {
  const Eigen::Vector3d vector(v.x, v.y, v.z);
  return to_world.linear().isIdentity(0) ? vector : Eigen::Vector3d(to_world.linear() * vector);
}

Eigen::Vector2d horizontal_in_world(const geometry_msgs::Vector3& v, const Eigen::Isometry3d& to_world,
                                    const std::string& path, const std::string& allowed) {
  constexpr double rounding = 1e-12;  // of a turn by a transform that others have computed
  const Eigen::Vector3d vector = vector_in_world(v, to_world);
  const double slack = to_world.linear().isIdentity(0) ? 0 : rounding * vector.norm();
  if (!(std::abs(vector.z()) <= slack)) throw SceneError(path, Tree(vector.z()).describe(), allowed);
  return vector.head<2>();
}

void check_height(double height, const Eigen::Isometry3d& to_world, double radius, const std::string& path) {
  constexpr double rounding = 1e-9;  // [m] of a transform that others have computed
  const double slack = is_identity(to_world) ? 0 : rounding;
  if (std::abs(height) <= slack || std::abs(height - radius) <= slack) return;
  throw SceneError(path, Tree(height).describe(), "0, or the radius " + Tree(radius).describe() + " [m]");
}

Eigen::Quaterniond orientation_in_world(const geometry_msgs::Quaternion& q,
                                        const Eigen::Isometry3d& to_world) {
  const bool is_given = q.x != 0 || q.y != 0 || q.z != 0 || q.w != 0;
  const Eigen::Quaterniond given =
      is_given ? Eigen::Quaterniond(q.w, q.x, q.y, q.z) : Eigen::Quaterniond::Identity();
  return to_world.linear().isIdentity(0) ? given : Eigen::Quaterniond(to_world.linear()) * given;
}

}  // namespace hybrid_sphere::ros_interface
