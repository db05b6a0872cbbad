#include "ros/node/map_server.hpp"

#include <algorithm>
#include <exception>
#include <stdexcept>
#include <utility>
#include <vector>

#include "ros/conversions/surface_grid.hpp"
#include "ros/conversions/surface_message.hpp"
#include "ros/node/publish_latched.hpp"
#include "ros/node/queues.hpp"
#include "ros/node/release_memory.hpp"
#include "scene/check.hpp"
#include "simulation/check_method.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

constexpr std::uint32_t latched_queue = 10;

/// Whether the pieces of a map are worth being given back to the system.
bool is_large(const SurfaceMap& map) {
  constexpr std::size_t many = 10000;
  std::size_t pieces = map.regions.size();
  for (const SurfaceRegion& region : map.regions) pieces += region.points.size();
  return pieces > many;
}

}  // namespace

MapServer::MapServer(const ros::NodeHandle& node, const MapSettings& settings,
                     std::shared_ptr<const Ground> ground, const Exchange& first,
                     ros::CallbackQueueInterface& loop, FrameTransformer& frames, PutInForce put_in_force)
    : settings_(settings),
      loop_(loop),
      frames_(frames),
      put_in_force_(std::move(put_in_force)),
      ground_(std::move(ground)),
      node_(with_queue(node, thread_.queue())),
      drawer_(node_, settings.world_frame, settings.radius, settings.drawn) {
  map_publisher_ = node_.advertise<SurfaceMap>("surface_map", latched_queue, true);
  message_ = message_from_surface(ground_->surface());
  publish_map(first.stamp);
  drawer_.draw(ground_, first.center);
  set_service_ = node_.advertiseService("set_surface_map", &MapServer::set_surface_map, this);
  get_service_ = node_.advertiseService("get_surface_map", &MapServer::get_surface_map, this);
  grid_subscriber_ = node_.subscribe("surface_grid", newest_only, &MapServer::take_grid, this);
  thread_.start();
}

void MapServer::free_left_maps() {
  if (left_.empty()) return;
  const auto is_free = [](const std::shared_ptr<const Ground>& ground) { return ground.use_count() == 1; };
  left_.erase(std::remove_if(left_.begin(), left_.end(), is_free), left_.end());
  if (left_.empty() && std::exchange(left_a_large_one_, false)) release_memory();
}

PlanarTransform MapServer::transform_of(const std::string& frame, const std::string& path) {
  return PlanarTransform::from(frames_.wait_for(frame, path), path);
}

bool MapServer::set_surface_map(SetSurfaceMap::Request& request, SetSurfaceMap::Response& response) {
  response.success = false;
  try {
    const PlanarTransform to_world = transform_of(request.map.header.frame_id, "map.header.frame_id");
    put(surface_from_message(request.map, to_world, settings_.forces));
    response.success = true;
  } catch (const std::exception& error) {
    response.message = error.what();
  }
  return true;
}

bool MapServer::get_surface_map(GetSurfaceMap::Request&, GetSurfaceMap::Response& response) {
  response.map = message_;
  return true;
}

void MapServer::take_grid(const nav_msgs::OccupancyGrid& grid) {
  try {
    const PlanarTransform to_world = transform_of(grid.header.frame_id, "surface_grid.header.frame_id");
    scene::Surface surface = surface_from_grid(grid, to_world, settings_.grid_threshold, settings_.ground);
    scene::check_pressure(surface, settings_.forces, "surface_grid");
    const std::size_t regions = surface.regions.size();
    put(std::move(surface));
    ROS_INFO("surface_grid: %u x %u cells are in force as %zu regions", grid.info.width, grid.info.height,
             regions);
  } catch (const std::exception& error) {
    grid_drops_.add(error.what());
  }
}

void MapServer::put(scene::Surface surface) {
  check_method(settings_.solver, settings_.dynamics, surface);
  auto ground = std::make_shared<const Ground>(std::move(surface));
  SurfaceMap message = message_from_surface(ground->surface());
  const ErrorEstimate estimate(settings_.dynamics, ground->surface());
  Exchange exchange{};
  std::exception_ptr failure;
  const auto put_there = [&] {
    try {
      exchange = put_in_force_(ground, estimate);
    } catch (...) {
      failure = std::current_exception();
    }
  };
  if (!thread_.run_in(loop_, put_there)) throw std::runtime_error("the node is shutting down");
  if (failure) std::rethrow_exception(failure);
  left_.push_back(std::exchange(ground_, std::move(ground)));
  left_a_large_one_ = left_a_large_one_ || is_large(message_);
  message_ = std::move(message);
  publish_map(exchange.stamp);
  drawer_.draw(ground_, exchange.center);
}

void MapServer::publish_map(const ros::Time& stamp) {
  message_.header.frame_id = settings_.world_frame;
  message_.header.stamp = stamp;
  publish_latched(map_publisher_, message_);
}

}  // namespace hybrid_sphere::ros_interface
