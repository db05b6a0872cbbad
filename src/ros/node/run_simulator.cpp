#include "ros/node/run_simulator.hpp"

#include <string>

#include "ros/node/run_node.hpp"
#include "ros/node/simulator_node.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

void run(const ros::NodeHandle& node) {
  const Configuration configuration = configuration_of(node);
  SimulatorNode simulator(node, configuration);
  const scene::SphereBody& body = configuration.scene.sphere;
  ROS_INFO("scene: sphere of %g kg, R = %g m, k = %g m; base %s, regions %zu; %g Hz; frames %s -> %s",
           body.mass, body.radius, body.gyration_radius,
           scene::to_string(configuration.scene.surface.base.law), configuration.scene.surface.regions.size(),
           configuration.node.adjustable.rate, configuration.node.frames.world.c_str(),
           configuration.node.frames.sphere.c_str());
  simulator.run();
}

std::string hint(const ros::NodeHandle& node) {
  return node.hasParam("sphere") ? "" : "; for a scene type: roslaunch hybrid_sphere sim.launch scene:=paper";
}

}  // namespace

Configuration configuration_of(const ros::NodeHandle& node) {
  // dynamic_reconfigure leaves ~accuracy on the parameter server, also for a run with another scene.
  double own = 0;
  double of_scene = 0;
  if (node.getParam("accuracy", own) && node.getParam("solver/accuracy", of_scene) && own != of_scene) {
    ROS_WARN("accuracy: %g overrides the scene's solver.accuracy: %g", own, of_scene);
  }
  return read_configuration(private_parameters(node));
}

int run_simulator(int argc, char** argv) {
  return run_node(argc, argv, {"hybrid_sphere_node", "hybrid_sphere", "scene", run, hint});
}

}  // namespace hybrid_sphere::ros_interface
