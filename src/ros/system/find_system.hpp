#pragma once

#include <memory>
#include <string>

#include "hybrid_sphere/ros/system_plugin.hpp"

namespace hybrid_sphere::ros_interface {

/// The system of a name: of the catalogue, or of a plugin of any package that ROS finds.
/// @throws scene::SceneError  with the names there are, or why a plugin cannot be loaded
std::shared_ptr<SystemPlugin> find_system(const std::string& name);

}  // namespace hybrid_sphere::ros_interface
