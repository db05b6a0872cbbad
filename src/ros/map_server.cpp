#include "hybrid_sphere/ros/map_server.hpp"

#include <exception>
#include <stdexcept>
#include <utility>
#include <vector>

#include "hybrid_sphere/ros/errand.hpp"
#include "hybrid_sphere/ros/serialized_markers.hpp"
#include "hybrid_sphere/ros/surface_grid.hpp"
#include "hybrid_sphere/ros/surface_markers.hpp"
#include "hybrid_sphere/ros/surface_message.hpp"
#include "hybrid_sphere/scene/read_scene.hpp"
#include "hybrid_sphere/simulation/check_method.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

constexpr std::uint32_t latched_queue = 10;
constexpr std::uint32_t newest_only = 1;

}  // namespace

MapServer::MapServer(const ros::NodeHandle& node, const MapSettings& settings,
                     std::shared_ptr<const Ground> ground, const Exchange& first,
                     ros::CallbackQueueInterface& loop, PutInForce put_in_force)
    : settings_(settings),
      loop_(loop),
      put_in_force_(std::move(put_in_force)),
      ground_(std::move(ground)),
      node_(node) {
  node_.setCallbackQueue(&queue_);
  map_publisher_ = node_.advertise<SurfaceMap>("surface_map", latched_queue, true);
  markers_publisher_ =
      node_.advertise<visualization_msgs::MarkerArray>("surface_markers", latched_queue, true);
  message_ = message_from_surface(ground_->surface());
  publish_map(first.stamp);
  draw_around({first.position});
  set_service_ = node_.advertiseService("set_surface_map", &MapServer::set_surface_map, this);
  get_service_ = node_.advertiseService("get_surface_map", &MapServer::get_surface_map, this);
  grid_subscriber_ = node_.subscribe("surface_grid", newest_only, &MapServer::take_grid, this);
  thread_ = std::thread([this] { handle_callbacks(); });
}

MapServer::~MapServer() {
  ends_ = true;
  thread_.join();
}

void MapServer::handle_callbacks() {
  const ros::WallDuration longest_wait(0.1);  // then whether it ends
  while (!ends_) queue_.callAvailable(longest_wait);
}

bool MapServer::set_surface_map(SetSurfaceMap::Request& request, SetSurfaceMap::Response& response) {
  response.success = false;
  try {
    put(surface_from_message(request.map, settings_.world_frame, settings_.forces));
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
    scene::Surface surface =
        surface_from_grid(grid, settings_.world_frame, settings_.grid_threshold, settings_.ground);
    scene::check_surface(surface, settings_.forces, "surface_grid");
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
  const auto shuts_down = [this] { return ends_ || !ros::ok(); };
  if (!run_in(
          loop_, [&] { exchange = put_in_force_(ground, estimate); }, shuts_down)) {
    throw std::runtime_error("the node shuts down");
  }
  left_ = std::exchange(ground_, std::move(ground));
  message_ = std::move(message);
  publish_map(exchange.stamp);
  draw_around({exchange.position});
}

void MapServer::publish_map(const ros::Time& stamp) {
  message_.header.frame_id = settings_.world_frame;
  message_.header.stamp = stamp;
  map_publisher_.publish(message_);
}

void MapServer::keep_in_view(const Vector2d& position) {
  std::vector<Vector2d> around;
  {
    const std::lock_guard<std::mutex> lock(view_mutex_);
    if (draw_waits_ || view_.contains(position)) return;
    around = {view_.center, position};
  }
  draw_around(std::move(around));
}

void MapServer::draw_around(std::vector<Vector2d> positions) {
  {
    const std::lock_guard<std::mutex> lock(view_mutex_);
    positions_ = std::move(positions);
    if (std::exchange(draw_waits_, true)) return;
  }
  post(queue_, [this] { draw(); });
}

void MapServer::draw() {
  std::vector<Vector2d> positions;
  {
    const std::lock_guard<std::mutex> lock(view_mutex_);
    positions = positions_;
  }
  const ViewSquare view = view_around(ground_->surface(), positions, settings_.radius);
  {
    const std::lock_guard<std::mutex> lock(view_mutex_);
    view_ = view;
    draw_waits_ = false;
  }
  const SerializedMarkers markers(surface_markers(*ground_, view, settings_.radius, settings_.world_frame));
  markers_publisher_.publish(markers);
}

}  // namespace hybrid_sphere::ros_interface
