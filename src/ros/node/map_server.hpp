#pragma once

#include <hybrid_sphere/GetSurfaceMap.h>
#include <hybrid_sphere/SetSurfaceMap.h>
#include <nav_msgs/OccupancyGrid.h>
#include <ros/ros.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ground/ground.hpp"
#include "ros/conversions/planar_transform.hpp"
#include "ros/node/callback_thread.hpp"
#include "ros/node/drop_log.hpp"
#include "ros/node/frame_transformer.hpp"
#include "ros/node/map_drawer.hpp"
#include "simulation/error_estimate.hpp"
#include "sphere/dynamics.hpp"

namespace hybrid_sphere::ros_interface {

/// What the map server knows of the node and its scene.
struct MapSettings {
  std::string world_frame;
  double radius;  ///< of the sphere [m]
  DrawnPart drawn;
  double grid_threshold;  ///< least occupancy of a rough cell, 1 to 100
  scene::Forces forces;   ///< that every map must go with
  scene::Surface ground;  ///< of the scene, whose base lies around the cells of a grid
  scene::Solver solver;   ///< the method exact is refused where a map needs integration
  Dynamics dynamics;      ///< of the scene's forces
};

/// The ground as ROS sees it: ~set_surface_map, ~get_surface_map, ~surface_grid, ~surface_map and
/// ~surface_markers. All of it happens in a thread of its own, one thing after the other, so that a large map
/// does not hold up the simulation, and what is drawn in another one (map_drawer.hpp): only the exchange of a
/// map that is ready is left to the simulation's thread, between two ticks.
class MapServer {
 public:
  /// When a map came into force, and what the camera looked at then.
  struct Exchange {
    ros::Time stamp;
    Vector2d center;  // of the picture [m]
  };
  /// Exchanges the map; called in the simulation's thread.
  using PutInForce =
      std::function<Exchange(const std::shared_ptr<const Ground>&, const ErrorEstimate& estimate)>;

  /// Publishes the map that is in force.
  /// @param node          whose private names the topics and services have
  /// @param loop          queue that the simulation's thread handles between ticks
  /// @param first         when the map came into force
  /// @param frames        of what comes in another frame; has to live as long as this
  MapServer(const ros::NodeHandle& node, const MapSettings& settings, std::shared_ptr<const Ground> ground,
            const Exchange& first, ros::CallbackQueueInterface& loop, FrameTransformer& frames,
            PutInForce put_in_force);

  /// Ends the thread; a request that waits is answered with a failure.
  ~MapServer() { thread_.stop(); }
  MapServer(const MapServer&) = delete;
  MapServer& operator=(const MapServer&) = delete;

  /// See MapDrawer.
  void keep_in_view(const Vector2d& center) { drawer_.keep_in_view(center); }
  std::shared_ptr<const std::vector<RegionName>> names() const { return drawer_.names(); }

 private:
  PlanarTransform transform_of(const std::string& frame, const std::string& path);
  bool set_surface_map(SetSurfaceMap::Request& request, SetSurfaceMap::Response& response);
  bool get_surface_map(GetSurfaceMap::Request& request, GetSurfaceMap::Response& response);
  void take_grid(const nav_msgs::OccupancyGrid& grid);

  /// Makes a surface the ground under the sphere, and waits until it is.
  /// @throws std::runtime_error  when the node shuts down before that
  void put(scene::Surface surface);
  void publish_map(const ros::Time& stamp);
  void free_left_maps();

  MapSettings settings_;
  ros::CallbackQueueInterface& loop_;
  FrameTransformer& frames_;
  PutInForce put_in_force_;
  std::shared_ptr<const Ground> ground_;  // in force
  // Those before, until nobody else has them: they are freed here and not in the simulation's thread.
  std::vector<std::shared_ptr<const Ground>> left_;
  bool left_a_large_one_ = false;
  SurfaceMap message_;
  DropLog grid_drops_{"surface_grid"};

  CallbackThread thread_{"a map request", [this] { free_left_maps(); }};
  ros::NodeHandle node_;
  ros::Publisher map_publisher_;
  MapDrawer drawer_;
  ros::ServiceServer set_service_;
  ros::ServiceServer get_service_;
  ros::Subscriber grid_subscriber_;
};

}  // namespace hybrid_sphere::ros_interface
