#include "ros/node/command.hpp"

#include "scene/check.hpp"
#include "scene/tree.hpp"

namespace hybrid_sphere::ros_interface {

using scene::SceneError;
using scene::Tree;

scene::Wrench wrench_from_message(const geometry_msgs::WrenchStamped& message, const std::string& world_frame,
                                  const scene::SphereBody& sphere) {
  const std::string& frame = message.header.frame_id;
  if (!frame.empty() && frame != world_frame) {
    throw SceneError("cmd_wrench.header.frame_id", Tree(frame).describe(),
                     Tree(world_frame).describe() + ", or empty");
  }
  const auto& force = message.wrench.force;
  const auto& torque = message.wrench.torque;
  if (force.z != 0) {
    throw SceneError("cmd_wrench.force[2]", Tree(force.z).describe(),
                     "0: gravity alone presses the sphere onto the ground [N]");
  }
  const scene::Wrench wrench{{force.x, force.y}, {torque.x, torque.y, torque.z}};
  scene::check_wrench(wrench, sphere, "cmd_wrench");
  return wrench;
}

void Command::take(const scene::Wrench& wrench, Wall::time_point now) {
  wrench_ = wrench;
  taken_ = now;
}

const scene::Wrench& Command::at(Wall::time_point now) {
  const double age = std::chrono::duration<double>(now - taken_).count();
  if (timeout_ != 0 && age > timeout_) drop();
  return wrench_;
}

}  // namespace hybrid_sphere::ros_interface
