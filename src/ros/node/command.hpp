#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <hybrid_sphere/Kick.h>

#include <Eigen/Geometry>

#include "hybrid_sphere/scene/scene.hpp"
#include "hybrid_sphere/scene/scene_error.hpp"
#include "ros/node/age_limit.hpp"

namespace hybrid_sphere::ros_interface {

/// The wrench on the centre that a message stands for, within the ranges of a scene's own wrench; paths of
/// errors begin with "cmd_wrench". Neither its stamp nor its frame is looked at.
/// @param to_world  turns directions of the message's frame to those of the world frame
/// @param sphere    whose mass and inertia bound the wrench
/// @throws scene::SceneError  with the path, the value and what is allowed
scene::Wrench wrench_from_message(const geometry_msgs::WrenchStamped& message,
                                  const Eigen::Isometry3d& to_world, const scene::SphereBody& sphere);

/// The change of the centre's velocity that a kick stands for [m/s]. The header is not looked at.
/// @param to_world  turns directions of the request's frame to those of the world frame
/// @param mass      of the sphere [kg]
/// @throws scene::SceneError  for an impulse that is not horizontal in the world, not finite or too large
Vector2d kick_from_message(const Kick::Request& request, const Eigen::Isometry3d& to_world, double mass);

/// The wrench that is commanded from outside: the last one that was taken, as long as it is not too old.
class Command {
 public:
  /// @param timeout  after which a wrench is dropped [s]; 0: never
  explicit Command(double timeout) : age_(timeout) {}

  void take(const scene::Wrench& wrench);

  /// From now on no wrench, until another one comes.
  void drop() { wrench_ = {}; }

  /// Drops the wrench if it is older than the timeout. To be called at each tick.
  /// @param clock  reading of the clock by which it ages [s]
  /// @return whether a wrench other than 0 has been dropped
  bool drop_if_too_old(double clock);

  /// In force.
  const scene::Wrench& wrench() const { return wrench_; }
  /// [s]; 0: never
  double timeout() const { return age_.longest(); }

 private:
  AgeLimit age_;
  scene::Wrench wrench_;
};

}  // namespace hybrid_sphere::ros_interface
