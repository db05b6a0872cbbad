#pragma once

#include <ros/ros.h>

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "ground/ground.hpp"
#include "ros/markers/picture.hpp"

namespace hybrid_sphere::ros_interface {

/// The part of a map that is drawn.
struct DrawnPart {
  double view_distance;  ///< of the camera from the point that it looks at [m]
  double ground_side;    ///< of a square around the origin beyond which nothing is drawn but bounded regions
                         ///< [m]; 0: none
};

/// Draws the ground on ~surface_markers, in a thread of its own: a large map takes seconds, in which whoever
/// has it drawn goes on. What is not of the last map any more is not drawn to its end.
class MapDrawer {
 public:
  /// @param node    whose private name the topic has
  /// @param radius  of the sphere [m]
  MapDrawer(ros::NodeHandle& node, std::string world_frame, double radius, const DrawnPart& part);
  /// Gives up what is being drawn.
  ~MapDrawer();
  MapDrawer(const MapDrawer&) = delete;
  MapDrawer& operator=(const MapDrawer&) = delete;

  /// Has a ground drawn; of several that wait the last one. Any thread; quick.
  /// @param center  the point that the camera looks at [m]
  void draw(std::shared_ptr<const Ground> ground, const Vector2d& center);
  /// Has it drawn anew when the picture of the camera comes to the edge of what is drawn, or when regions
  /// without a name may have come into the picture. Names that are written stay. Any thread; quick.
  /// @param center  the point that the camera looks at [m]
  void keep_in_view(const Vector2d& center);
  /// The names that are written. Any thread; quick.
  std::shared_ptr<const std::vector<RegionName>> names() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return names_;
  }

 private:
  /// The next drawing.
  struct Task {
    std::shared_ptr<const Ground> ground;
    Vector2d center;  // of the picture [m]
  };

  void run();
  bool is_seen(const Vector2d& center) const;
  ViewSquare square_for(const Task& task, bool is_new_ground, bool limited) const;
  std::size_t publish(const Task& task, const ViewSquare& view, bool is_new_ground, bool is_new_square);

  std::string world_frame_;
  double radius_;
  DrawnPart part_;
  ros::Publisher publisher_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Task task_{nullptr, Vector2d::Zero()};  // to be drawn, or drawn
  std::shared_ptr<const Ground> drawn_;   // or being drawn
  ViewSquare view_{Vector2d::Zero(), 0};  // the same
  std::shared_ptr<const std::vector<RegionName>> names_ = std::make_shared<const std::vector<RegionName>>();
  bool is_limited_ = false;  // what is drawn ends at the limit of part_
  bool waits_ = false;
  bool ends_ = false;
  std::atomic<bool> outdated_{false};  // what is being drawn
  std::thread thread_;                 // last: it uses all the others
};

}  // namespace hybrid_sphere::ros_interface
