#pragma once

#include <XmlRpcValue.h>

#include <string>

#include "hybrid_sphere/scene/scene.hpp"
#include "scene/tree.hpp"

namespace hybrid_sphere::ros_interface {

/// Names of the coordinate frames that the node speaks of.
struct Frames {
  std::string world = "world";    ///< fixed, z up, the ground is z = 0
  std::string sphere = "sphere";  ///< fixed in the sphere, origin at its centre
  /// Goes with the sphere and does not turn, origin at the contact.
  std::string contact() const { return sphere + "_contact"; }
  std::string view{};  ///< follows the sphere in the picture and does not turn; empty: is not sent
};

/// How the sphere's trail and impulses are drawn.
struct MarkerStyle {
  int trail_length = 2000;         ///< corners that are kept; 0: no trail
  double impulse_lifetime = 3600;  ///< how long an impulse is shown [s of simulated time]
  double arrow_scale = 1;          ///< length of the arrows, in units of the usual one
};

inline constexpr double least_real_time_factor = 1e-3;  ///< beside 0

/// What may be changed while the node runs.
struct Adjustable {
  double rate = 100;            ///< outputs per second of simulated time [Hz]
  double real_time_factor = 1;  ///< simulated seconds in one of wall time; 0: as fast as it can
  double accuracy = scene::Solver().accuracy;  ///< instead of solver.accuracy
  MarkerStyle markers;
};

/// Whose time it is.
enum class ClockMode {
  own,     ///< that of the wall; nobody is told
  lead,    ///< that of the wall; this node publishes /clock
  follow,  ///< that of somebody else's /clock
};

/// How time passes in a node, beside Adjustable.
struct TimeParameters {
  bool paused = false;  ///< time stands until ~pause or ~step
  ClockMode clock = ClockMode::own;
  bool resets_on_jump_back = true;  ///< what a followed clock that jumps back does; else the state is held
  double wait_for_viewer = 0;       ///< for a listener of ~markers, before time begins [s of wall time]
  double clock_rate = 0;            ///< most messages of /clock in a second of wall time [Hz]; 0: one a tick
  bool catches_up = false;          ///< after a stop of the process: leaves out all ticks that are over
  bool inputs_age_by_wall = false;  ///< while time runs; else by simulated time
  bool diagnostics = true;          ///< whether /diagnostics is published
  double diagnostic_period = 1;     ///< [s of wall time]
  int realtime_priority = 0;        ///< of the loop, SCHED_FIFO; 0: scheduled like any other process
};

/// The node's own parameters, without those of the scene.
struct NodeParameters : TimeParameters {
  Adjustable adjustable;
  double command_timeout = 0.5;  ///< after which a commanded wrench is dropped [s]; 0: never
  bool rviz_tools = true;        ///< whether rviz's tools and the handle move the sphere
  double kick = 1;               ///< impulse over mass of a kick by clicked_point [m/s]; 0: none
  double ground_side = 0;      ///< of the square around the origin in which ground is drawn [m]; 0: no limit
  double grid_threshold = 65;  ///< least occupancy of a cell of ~surface_grid that is rough [%]
  std::string
      scene_directory;  ///< what relative names of images are relative to; empty: the working directory
  std::string
      working_directory;  ///< what a relative ~scene_file is relative to; empty: the working directory
  Frames frames;
};

struct Configuration {
  NodeParameters node;
  scene::Scene scene;
};

/// A value of the parameter server as a tree. Integers become numbers, and so does text below the first level
/// that a scene file would have as a number; dates, binary data and what is nested deeper than a scene file
/// may be are refused.
/// @param path  put before the keys in error messages
/// @throws scene::SceneError
scene::Tree tree_from_parameters(const XmlRpc::XmlRpcValue& value, const std::string& path = "");

/// The name of a frame. @throws scene::SceneError
std::string read_frame(const scene::Tree& tree, const std::string& path);

/// The parameters of the node among other keys, which are passed over.
/// @throws scene::SceneError  with the key, the value and what is allowed
NodeParameters read_node_parameters(const scene::Tree::Map& keys);

/// The node's private parameters: those of Adjustable and MarkerStyle (`accuracy` goes before the scene's),
/// those of NodeParameters (the frames are world_frame and sphere_frame), all the others are the scene's.
/// @throws scene::SceneError  with the key's full path, the value and what is allowed
Configuration read_configuration(const scene::Tree& tree);

}  // namespace hybrid_sphere::ros_interface
