#include "hybrid_sphere/ros/simulator_node.hpp"

int main(int argc, char** argv) { return hybrid_sphere::ros_interface::run_simulator(argc, argv); }
