#include "ros/node/command.hpp"

#include "ros/conversions/world_coordinates.hpp"
#include "scene/check.hpp"
#include "scene/tree.hpp"

namespace hybrid_sphere::ros_interface {

scene::Wrench wrench_from_message(const geometry_msgs::WrenchStamped& message,
                                  const Eigen::Isometry3d& to_world, const scene::SphereBody& sphere) {
  const scene::Wrench wrench{horizontal_in_world(message.wrench.force, to_world, "cmd_wrench.force[2]",
                                                 "0: gravity alone presses the sphere onto the ground [N]"),
                             vector_in_world(message.wrench.torque, to_world)};
  scene::check_wrench(wrench, sphere, "cmd_wrench");
  return wrench;
}

Vector2d kick_from_message(const Kick::Request& request, const Eigen::Isometry3d& to_world, double mass) {
  constexpr double largest = 1e15;  // [m/s], the largest velocity of a scene
  const Vector2d impulse =
      horizontal_in_world(request.impulse, to_world, "impulse.z", "0: the sphere stays on the ground [N s]");
  const Vector2d change = impulse / mass;
  if (!(change.norm() <= largest)) {
    const auto& given = request.impulse;
    throw scene::SceneError("impulse", scene::Tree(scene::Tree::List{given.x, given.y, given.z}).describe(),
                            "finite impulses up to the mass times 1e15 m/s [N s]");
  }
  return change;
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
