#include "ros/node/run_simulator.hpp"

#include <cctype>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "ros/node/simulator_node.hpp"

namespace hybrid_sphere::ros_interface {

Configuration configuration_of(const ros::NodeHandle& node) {
  XmlRpc::XmlRpcValue parameters;
  const bool any = ros::param::get(node.getNamespace(), parameters);
  // dynamic_reconfigure leaves ~accuracy on the parameter server, also for a run with another scene.
  double own = 0;
  double of_scene = 0;
  if (node.getParam("accuracy", own) && node.getParam("solver/accuracy", of_scene) && own != of_scene) {
    ROS_WARN("accuracy: %g overrides the scene's solver.accuracy: %g", own, of_scene);
  }
  return read_configuration(any ? tree_from_parameters(parameters) : scene::Tree(scene::Tree::Map{}));
}

namespace {

/// Private parameters that are given as arguments, `_rate:=500`: roscpp writes them to the parameter server.
std::vector<std::string> parameters_of(int argc, char** argv) {
  std::vector<std::string> names;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const std::size_t end = argument.find(":=");
    const bool is_private = argument.rfind('_', 0) == 0 && end != std::string::npos && end > 1;
    if (is_private && std::isalpha(static_cast<unsigned char>(argument[1])) != 0)
      names.push_back(argument.substr(1, end - 1));
  }
  return names;
}

}  // namespace

int run_simulator(int argc, char** argv) {
  const std::vector<std::string> given = parameters_of(argc, argv);
  try {
    ros::init(argc, argv, "hybrid_sphere");
  } catch (const ros::Exception& error) {  // a name that none can have, as in `_~rate:=0`
    std::cerr << "hybrid_sphere_node: " << error.what() << '\n';
    return 2;
  }
  const ros::NodeHandle node("~");
  try {
    const Configuration configuration = configuration_of(node);
    SimulatorNode simulator(node, configuration);
    const scene::SphereBody& body = configuration.scene.sphere;
    ROS_INFO("scene: sphere of %g kg, R = %g m, k = %g m; base %s, regions %zu; %g Hz; frames %s -> %s",
             body.mass, body.radius, body.gyration_radius,
             scene::to_string(configuration.scene.surface.base.law),
             configuration.scene.surface.regions.size(), configuration.node.adjustable.rate,
             configuration.node.frames.world.c_str(), configuration.node.frames.sphere.c_str());
    simulator.run();
    return 0;
  } catch (const scene::SceneError& error) {
    const char* hint =
        node.hasParam("sphere") ? "" : "; for a scene type: roslaunch hybrid_sphere sim.launch scene:=paper";
    ROS_FATAL("scene refused: %s%s", error.what(), hint);
    for (const std::string& name : given) node.deleteParam(name);  // they would be refused next time, too
    return 3;
  } catch (const std::exception& error) {
    ROS_FATAL("the computation cannot continue: %s", error.what());
    return 4;
  }
}

}  // namespace hybrid_sphere::ros_interface
