#include "ros/node/map_drawer.hpp"

#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <exception>
#include <utility>
#include <variant>

#include "interrupt/interrupt.hpp"
#include "ros/markers/surface_markers.hpp"
#include "ros/node/publish_latched.hpp"
#include "ros/node/release_memory.hpp"
#include "ros/node/serialized_markers.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

/// Whether the limit of what is drawn holds: all bounded regions have to lie inside it.
bool is_limited(const Ground& ground, const DrawnPart& part) {
  if (part.ground_side == 0) return false;
  const Eigen::Vector3d reach(0.5 * part.ground_side, 0.5 * part.ground_side, 0);
  return Eigen::AlignedBox3d(-reach, reach).contains(bounded_extent(ground.surface()));
}

}  // namespace

MapDrawer::MapDrawer(ros::NodeHandle& node, std::string world_frame, double radius, const DrawnPart& part)
    : world_frame_(std::move(world_frame)), radius_(radius), part_(part) {
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

void MapDrawer::draw(std::shared_ptr<const Ground> ground, const Vector2d& center) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    task_.ground.swap(ground);
    task_.center = center;
    waits_ = true;
    outdated_ = true;
  }
  changed_.notify_one();
}

/// Whether all of the picture is drawn.
bool MapDrawer::is_seen(const Vector2d& center) const {
  if (is_limited_) return true;
  const Vector2d reach = Vector2d::Constant(picture_part::seen * part_.view_distance);
  return view_.contains(center - reach) && view_.contains(center + reach);
}

void MapDrawer::keep_in_view(const Vector2d& center) {
  constexpr double way_to_new_names = 0.5 * picture_part::whole;  // in distances of the camera
  constexpr RegionId max_regions = 1000;  // of a map that is looked through again and again
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (waits_ || !task_.ground) return;
    const double way = (center - task_.center).lpNorm<Eigen::Infinity>();
    const bool may_have_new_names =
        way > way_to_new_names * part_.view_distance && task_.ground->size() <= max_regions;
    if (is_seen(center) && !may_have_new_names) return;
    task_.center = center;
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
    Task task = task_;
    std::shared_ptr<const Ground> previous = drawn_;  // is freed without the lock
    const bool is_new_ground = task.ground != previous;
    lock.unlock();
    const bool limited = is_limited(*task.ground, part_);
    const ViewSquare view = square_for(task, is_new_ground, limited);
    lock.lock();
    if (ends_) return;
    if (task.ground != task_.ground) continue;  // another one waits
    const bool is_new_square = is_new_ground || view.half != view_.half;
    view_ = view;
    is_limited_ = limited;
    drawn_ = task.ground;
    waits_ = outdated_ = false;
    lock.unlock();
    previous.reset();
    std::size_t bytes = bytes_before;
    try {
      bytes = publish(task, view, is_new_ground, is_new_square);
    } catch (const Interrupted&) {
      // Another ground waits to be drawn, or the end.
    } catch (const std::exception& error) {
      ROS_ERROR("cannot draw the ground: %s", error.what());
    }
    task.ground.reset();
    if (std::max(bytes, std::exchange(bytes_before, bytes)) > large) release_memory();
    lock.lock();
  }
}

/// The square that is drawn. It grows by more than is missing, so that it is drawn rarely.
ViewSquare MapDrawer::square_for(const Task& task, bool is_new_ground, bool limited) const {
  if (!is_new_ground && is_seen(task.center)) return view_;
  if (limited) return {Vector2d::Zero(), 0.5 * part_.ground_side};
  const double ahead = is_new_ground ? 1.2 : 1.5;
  ViewSquare square = is_new_ground ? view_around(task.ground->surface(), {task.center}, radius_) : view_;
  const double away = (task.center - square.center).lpNorm<Eigen::Infinity>();
  square.half = std::max(square.half, ahead * (away + picture_part::seen * part_.view_distance));
  return square;
}

/// Draws the ground again only if the square or a name is new. @return size of the message [bytes]
std::size_t MapDrawer::publish(const Task& task, const ViewSquare& view, bool is_new_ground,
                               bool is_new_square) {
  Picture picture = picture_around(task.center, part_.view_distance);
  constexpr std::size_t most_names = 500;  // of a sphere that travels far
  if (!is_new_ground && names()->size() < most_names) picture.names = *names();
  const std::size_t names_before = picture.names.size();
  const visualization_msgs::MarkerArray drawing =
      surface_markers(*task.ground, view, radius_, world_frame_, &picture);
  if (!is_new_square && picture.names.size() == names_before) return 0;
  const SerializedMarkers markers(drawing);
  publish_latched(publisher_, markers);
  const auto written = std::make_shared<const std::vector<RegionName>>(std::move(picture.names));
  const std::lock_guard<std::mutex> lock(mutex_);
  names_ = written;
  return markers.bytes.num_bytes;
}

}  // namespace hybrid_sphere::ros_interface
