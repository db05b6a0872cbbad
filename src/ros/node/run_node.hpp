#pragma once

#include <ros/ros.h>

#include <functional>
#include <string>

#include "scene/tree.hpp"

namespace hybrid_sphere::ros_interface {

/// A program that is a node.
struct NodeProgram {
  const char* program;                              ///< its name
  const char* node;                                 ///< its name as a node, where no other one is given
  const char* what;                                 ///< what is refused: "scene"
  std::function<void(const ros::NodeHandle&)> run;  ///< until ROS shuts down; with the private names
  std::function<std::string(const ros::NodeHandle&)> hint;  ///< put behind a refusal
};

/// Runs it. What it throws ends it.
/// @return the exit code: 0 shut down, 2 usage, 3 refused (scene::SceneError), 4 the computation could not go
/// on
int run_node(int argc, char** argv, const NodeProgram& program);

/// The private parameters of a node, all of them.
scene::Tree private_parameters(const ros::NodeHandle& node);

}  // namespace hybrid_sphere::ros_interface
