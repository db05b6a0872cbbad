#include "ros/node/map_drawer.hpp"

#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <exception>
#include <utility>
#include <variant>

#include "interrupt/interrupt.hpp"
#include "ros/markers/surface_markers.hpp"
#include "ros/node/release_memory.hpp"
#include "ros/node/serialized_markers.hpp"

namespace hybrid_sphere::ros_interface {

MapDrawer::MapDrawer(ros::NodeHandle& node, std::string world_frame, double radius)
    : world_frame_(std::move(world_frame)), radius_(radius) {
  constexpr std::uint32_t latched_queue = 10;
  publisher_ = node.advertise<visualization_msgs::MarkerArray>("surface_markers", latched_queue, true);
  thread_ = std::thread([this] { run(); });
}

MapDrawer::~MapDrawer() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
    outdated_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void MapDrawer::draw(std::shared_ptr<const Ground> ground, const Vector2d& position,
                     const Vector2d& velocity) {
  constexpr double ahead = 3;      // [s]
  constexpr double longest = 200;  // radii
  const auto has_end = [](const scene::Region& region) {
    return !std::holds_alternative<scene::HalfPlane>(region.shape);
  };
  const auto& regions = ground->surface().regions;
  std::vector<Vector2d> in_view = {position};
  if (std::none_of(regions.begin(), regions.end(), has_end)) {
    const double time = std::min(ahead, longest * radius_ / velocity.stableNorm());
    for (const Vector2d& end : {velocity, Vector2d(-velocity)}) in_view.emplace_back(position + time * end);
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ground_.swap(ground);
    in_view_ = std::move(in_view);
    waits_ = true;
    outdated_ = true;
  }
  changed_.notify_one();
}

void MapDrawer::keep_in_view(const Vector2d& position) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (waits_ || view_.contains(position)) return;
    in_view_ = {view_.center, position};
    waits_ = true;
  }
  changed_.notify_one();
}

void MapDrawer::run() {
  constexpr std::size_t large = 1 << 22;  // bytes
  const ShouldStop is_outdated = [this] { return outdated_.load(); };
  const InterruptScope interruptible(is_outdated);
  std::size_t bytes_before = 0;
  std::unique_lock<std::mutex> lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return waits_ || ends_; });
    if (ends_) return;
    std::shared_ptr<const Ground> ground = ground_;
    const std::vector<Vector2d> in_view = std::move(in_view_);
    lock.unlock();
    const ViewSquare view = view_around(ground->surface(), in_view, radius_);
    lock.lock();
    if (ends_) return;
    if (ground != ground_) continue;  // another one waits
    view_ = view;
    waits_ = outdated_ = false;
    lock.unlock();
    std::size_t bytes = bytes_before;
    try {
      bytes = publish(*ground, view);
    } catch (const Interrupted&) {
      // Another ground waits to be drawn, or the end.
    } catch (const std::exception& error) {
      ROS_ERROR("cannot draw the ground: %s", error.what());
    }
    ground.reset();
    if (std::max(bytes, std::exchange(bytes_before, bytes)) > large) release_memory();
    lock.lock();
  }
}

/// @return size of the message
std::size_t MapDrawer::publish(const Ground& ground, const ViewSquare& view) const {
  const SerializedMarkers markers(surface_markers(ground, view, radius_, world_frame_));
  publisher_.publish(markers);
  return markers.bytes.num_bytes;
}

}  // namespace hybrid_sphere::ros_interface
