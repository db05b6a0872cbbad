#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hybrid_sphere/mechanics/solve.hpp"
#include "ros/node/parameters.hpp"

namespace hybrid_sphere::ros_interface {

/// The private parameters of three_stage_node.
struct SystemConfiguration {
  std::string system;                                  ///< name of the catalogue, or of a plugin
  std::vector<std::pair<std::string, double>> values;  ///< ~values: numbers of the system
  std::optional<double>
      duration;  ///< over which errors may add up to the accuracy, instead of the system's [s]
  double accuracy = mechanics::Options().accuracy;
  std::string world_frame = Frames().world;
  std::string frame_prefix;    ///< of the frames of bodies
  double command_timeout = 0;  ///< after which an input gives way to the initial one [s]; 0: never
  TimeParameters time;
  Adjustable adjustable;  ///< rate and real_time_factor
};

/// @throws scene::SceneError  with the key's full path, the value and what is allowed
SystemConfiguration read_system_configuration(const scene::Tree& tree);

}  // namespace hybrid_sphere::ros_interface
