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
#include "ros/markers/surface_outline.hpp"

namespace hybrid_sphere::ros_interface {

/// Draws the ground on ~surface_markers, in a thread of its own: a large map takes seconds, in which whoever
/// has it drawn goes on. What is not of the last map any more is not drawn to its end.
class MapDrawer {
 public:
  /// @param node    whose private name the topic has
  /// @param radius  of the sphere [m]
  MapDrawer(ros::NodeHandle& node, std::string world_frame, double radius);
  /// Gives up what is being drawn.
  ~MapDrawer();
  MapDrawer(const MapDrawer&) = delete;
  MapDrawer& operator=(const MapDrawer&) = delete;

  /// Has a ground drawn; of several that wait the last one. Any thread; quick.
  /// @param position  of the sphere, in view [m]
  /// @param velocity  of it: where nothing on the map has an end, the way of some seconds is in view [m/s]
  void draw(std::shared_ptr<const Ground> ground, const Vector2d& position, const Vector2d& velocity);
  /// Has it drawn anew when the sphere has left what is drawn. Any thread; quick.
  /// @param position  of the sphere [m]
  void keep_in_view(const Vector2d& position);
  /// Half the side of the square that is drawn [m]. Any thread; quick.
  double view_half() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return view_.half;
  }

 private:
  void run();
  std::size_t publish(const Ground& ground, const ViewSquare& view) const;

  std::string world_frame_;
  double radius_;
  ros::Publisher publisher_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::shared_ptr<const Ground> ground_;  // to be drawn, or drawn
  std::vector<Vector2d> in_view_;         // when it is drawn next
  ViewSquare view_{Vector2d::Zero(), 0};  // what is drawn, or is being drawn
  bool waits_ = false;
  bool ends_ = false;
  std::atomic<bool> outdated_{false};  // what is being drawn
  std::thread thread_;                 // last: it uses all the others
};

}  // namespace hybrid_sphere::ros_interface
