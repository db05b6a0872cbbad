#pragma once

namespace hybrid_sphere::ros_interface {

/// Runs the node of any system until ROS shuts down. Returns the exit code: see run_node.
int run_system(int argc, char** argv);

}  // namespace hybrid_sphere::ros_interface
