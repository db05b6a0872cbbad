#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <vector>

#include "hybrid_sphere/simulation/records.hpp"
#include "hybrid_sphere/sphere/sphere.hpp"
#include "ros/markers/picture_box.hpp"
#include "ros/markers/region_names.hpp"
#include "ros/markers/slip_arrow.hpp"
#include "ros/node/parameters.hpp"

namespace hybrid_sphere::ros_interface {

/// The sphere, its trail, its slip and its impulses for rviz. The sphere itself is a large message that is
/// needed rarely (ball_mesh.hpp); the rest is small.
class SphereMarkers {
 public:
  SphereMarkers(const Frames& frames, const Sphere& sphere, const MarkerStyle& style);

  /// From now on.
  void set_style(const MarkerStyle& style);

  /// Forgets the trail and the impulses: the sphere was put somewhere.
  void start_at(const Vector2d& position);

  /// Adds a corner of the trail and, where there is one, an impulse.
  /// @param stamp  of the switch
  void add(const Switch& event, const ros::Time& stamp);

  /// The sphere itself.
  const visualization_msgs::MarkerArray& ball() const { return ball_; }

  /// Trail, slip and impulses. Each impulse is sent once, and again when its label has to leave the place
  /// where the sphere or a name is now. It is shown for impulse_lifetime.
  /// @param all    every impulse that is still to be seen, for a new listener
  /// @param unit   half the side of a square that fills the picture: letters are measured in it [m]
  /// @param names  written on the ground
  const visualization_msgs::MarkerArray& update(const State& state, const ros::Time& stamp, bool all,
                                                double unit = 0, const std::vector<RegionName>& names = {});

 private:
  struct Impulse {
    visualization_msgs::Marker arrow;
    visualization_msgs::Marker label;
    Vector2d tip;       // of the arrow [m]
    Vector2d along;     // of length 1
    Vector2d velocity;  // before the switch [m/s]
    PictureBox box;     // of the label
    bool has_label = false;
    ros::Time until;
    bool sent = false;
  };

  void add_to_trail(const Vector2d& position);
  void shorten_trail(std::size_t corners);
  void lead_trail(const Vector2d& position);
  Impulse draw(const Switch& event) const;
  void remove(const Impulse& impulse);
  bool is_free(const PictureBox& box, const Impulse& own) const;
  void place_label(Impulse& impulse, double unit) const;
  void push(Impulse& impulse, const ros::Time& stamp);

  std::size_t longest_trail() const { return static_cast<std::size_t>(style_.trail_length); }

  Frames frames_;
  Sphere sphere_;
  MarkerStyle style_;
  visualization_msgs::MarkerArray ball_;
  visualization_msgs::MarkerArray update_;
  SlipArrow slip_;
  visualization_msgs::Marker trail_;  // its last point is the sphere
  std::vector<Impulse> impulses_;
  double unit_ = 0;
  std::vector<PictureBox> obstacles_;    // the sphere and the names
  std::vector<std::int32_t> to_delete_;  // impulses that are shown and no longer wanted
  std::int32_t next_id_ = 0;
};

}  // namespace hybrid_sphere::ros_interface
