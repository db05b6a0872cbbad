#pragma once

#include <hybrid_sphere/SystemState.h>
#include <hybrid_sphere/SystemSwitch.h>
#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/MarkerArray.h>

#include <optional>
#include <string>
#include <vector>

#include "ros/system/body_trail.hpp"
#include "ros/system/constraint_markers.hpp"
#include "ros/system/system_plant.hpp"
#include "ros/view/view_publisher.hpp"

namespace hybrid_sphere::ros_interface {

/// The messages of a system with their headers. Each is filled again and again: what a function returns is
/// valid until its next call.
class SystemMessages {
 public:
  /// @param frame_prefix   before the frame of each body
  /// @param view_frame     frame that the camera looks at
  /// @param plant, system  have to live as long as this
  /// @throws std::invalid_argument  for a body that cannot be drawn
  SystemMessages(const std::string& world_frame, const std::string& frame_prefix,
                 const std::string& view_frame, const SystemPlant& plant, const SystemPlugin& system);

  /// One entry for each coordinate, where the velocities are their rates. Where they are not, entries for the
  /// coordinates, with q' as velocity and no effort, and behind them those for the velocities, without
  /// position.
  const sensor_msgs::JointState& joints(const mechanics::State& state, const ros::Time& stamp);
  const SystemState& state(const mechanics::State& state, const ros::Time& stamp);
  const SystemSwitch& event(const mechanics::Switch& event, const ros::Time& stamp);
  /// Whether the system gives poses.
  bool has_bodies() const { return !bodies_.empty(); }
  /// The first body, if there is one, as a camera frames it.
  std::optional<FramedBody> framed_body(const mechanics::State& state) const;
  /// The poses of the bodies, and the frame of the view, which follows the first body.
  const tf2_msgs::TFMessage& transforms(const mechanics::State& state, const ros::Time& stamp,
                                        ViewPublisher& view);
  /// The bodies, the trail of the first one, its constraints and its impulses.
  /// @param unit  half the side of a square that fills the picture [m]
  const visualization_msgs::MarkerArray& markers(const mechanics::State& state, double unit);
  /// Draws the impulse of a switch from now on, if there are bodies.
  void show(const mechanics::Switch& event);
  /// Forgets what is drawn of the motion before a reset.
  void restart() { constraints_.clear(); }

 private:
  std::vector<Eigen::Isometry3d> poses(const mechanics::State& state) const;
  Eigen::Vector3d velocity_of_first(const mechanics::State& state) const;
  double half_width() const;

  const SystemPlant& plant_;
  const SystemPlugin& system_;
  std::vector<Body> bodies_;
  bool has_rates_;  // the velocities are those of the coordinates
  sensor_msgs::JointState joints_;
  SystemState state_;
  SystemSwitch event_;
  tf2_msgs::TFMessage transforms_;
  visualization_msgs::MarkerArray markers_;  // those of bodies come first
  std::size_t shapes_ = 0;                   // as many
  BodyTrail trail_;                          // of the first body
  ConstraintMarkers constraints_;
};

}  // namespace hybrid_sphere::ros_interface
