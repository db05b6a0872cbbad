#pragma once

namespace hybrid_sphere::ros_interface {

/// Reads the private parameters and runs the node.
/// @return  exit code: 0 shut down, 2 usage, 3 scene refused, 4 the computation could not go on
int run_simulator(int argc, char** argv);

}  // namespace hybrid_sphere::ros_interface
