#pragma once

#include <geometry_msgs/WrenchStamped.h>

#include <Eigen/Geometry>
#include <chrono>

#include "hybrid_sphere/scene/scene.hpp"
#include "hybrid_sphere/scene/scene_error.hpp"

namespace hybrid_sphere::ros_interface {

/// The wrench on the centre that a message stands for, within the ranges of a scene's own wrench; paths of
/// errors begin with "cmd_wrench". Neither its stamp nor its frame is looked at.
/// @param to_world  turns directions of the message's frame to those of the world frame
/// @param sphere    whose mass and inertia bound the wrench
/// @throws scene::SceneError  with the path, the value and what is allowed
scene::Wrench wrench_from_message(const geometry_msgs::WrenchStamped& message,
                                  const Eigen::Isometry3d& to_world, const scene::SphereBody& sphere);

/// The wrench that is commanded from outside: the last one that was taken, as long as it is not too old.
class Command {
 public:
  using Wall = std::chrono::steady_clock;

  /// @param timeout  after which a wrench is dropped [s]; 0: never
  explicit Command(double timeout) : timeout_(timeout) {}

  /// @param now  when it came
  void take(const scene::Wrench& wrench, Wall::time_point now);

  /// From now on no wrench, until another one comes.
  void drop() { wrench_ = {}; }

  /// The wrench in force; none once the last one is older than the timeout.
  const scene::Wrench& at(Wall::time_point now);

 private:
  double timeout_;
  scene::Wrench wrench_;
  Wall::time_point taken_{};
};

}  // namespace hybrid_sphere::ros_interface
