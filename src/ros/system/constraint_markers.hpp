#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <Eigen/Core>
#include <string>
#include <vector>

#include "ros/markers/picture_box.hpp"

namespace hybrid_sphere::ros_interface {

/// A switch with an impulse, as the first body has it.
struct DrawnImpulse {
  std::string constraints;        ///< names of those that give the impulse
  Eigen::Vector3d place;          ///< of the body [m]
  Eigen::Vector3d velocity;       ///< of its origin before the switch [m/s]
  Eigen::Vector3d next_velocity;  ///< after it [m/s]
};

/// For rviz: beside the first body the names of the constraints that hold, and at each impulse an arrow along
/// the change of the body's velocity, with the names of the constraints.
class ConstraintMarkers {
 public:
  /// @param half_width  of the body in the picture [m]
  ConstraintMarkers(const std::string& world_frame, double half_width);

  void add(const DrawnImpulse& impulse);
  /// Forgets the impulses: the motion starts again.
  void clear();

  /// Appends the markers for a body at a place.
  /// @param active  names of the constraints that hold
  /// @param unit    half the side of a square that fills the picture: letters are measured in it [m]
  void append_to(visualization_msgs::MarkerArray& markers, const Eigen::Vector3d& place,
                 const std::string& active, double unit);

 private:
  struct Drawn {
    visualization_msgs::Marker arrow;
    visualization_msgs::Marker label;
    PictureBox box;  // of the label
    bool is_placed = false;
  };

  void place_label(Drawn& drawn, double size, const PictureBox& body) const;
  void write_active(visualization_msgs::MarkerArray& markers, const Eigen::Vector3d& place, double size);

  std::string world_frame_;
  double half_width_;
  std::vector<Drawn> impulses_;
  std::size_t cleared_ = 0;  // impulses that are shown and no longer wanted
  visualization_msgs::Marker active_;
};

}  // namespace hybrid_sphere::ros_interface
