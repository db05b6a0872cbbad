#include "ros/node/command.hpp"

#include <cmath>

#include "scene/check.hpp"
#include "scene/tree.hpp"

namespace hybrid_sphere::ros_interface {

using scene::SceneError;
using scene::Tree;

namespace {

/// In world axes; without a turn the same numbers.
Vector3d turned(const geometry_msgs::Vector3& v, const Eigen::Matrix3d& axes) {
  const Vector3d vector(v.x, v.y, v.z);
  return axes.isIdentity(0) ? vector : Vector3d(axes * vector);
}

}  // namespace

scene::Wrench wrench_from_message(const geometry_msgs::WrenchStamped& message,
                                  const Eigen::Isometry3d& to_world, const scene::SphereBody& sphere) {
  constexpr double rounding = 1e-12;  // of a turn
  const Vector3d force = turned(message.wrench.force, to_world.linear());
  const bool is_turned = !to_world.linear().isIdentity(0);
  if (!(std::abs(force.z()) <= (is_turned ? rounding * force.norm() : 0))) {
    throw SceneError("cmd_wrench.force[2]", Tree(force.z()).describe(),
                     "0: gravity alone presses the sphere onto the ground [N]");
  }
  const scene::Wrench wrench{force.head<2>(), turned(message.wrench.torque, to_world.linear())};
  scene::check_wrench(wrench, sphere, "cmd_wrench");
  return wrench;
}

void Command::take(const scene::Wrench& wrench) {
  wrench_ = wrench;
  age_.begin();
}

bool Command::drop_if_too_old(double clock) {
  const bool drops = age_.is_over(clock) && (!wrench_.force.isZero(0) || !wrench_.torque.isZero(0));
  if (drops) drop();
  return drops;
}

}  // namespace hybrid_sphere::ros_interface
