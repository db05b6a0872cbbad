#include "ros/system/run_system.hpp"

#include <memory>
#include <stdexcept>
#include <string>

#include "hybrid_sphere/scene/scene_error.hpp"
#include "ros/node/run_node.hpp"
#include "ros/system/find_system.hpp"
#include "ros/system/system_node.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

/// Reports an exception of the system or the engine as an error in the configuration.
/// @param where  put before what is refused
template <class Function>
auto refusing(const std::string& where, const Function& function) {
  try {
    return function();
  } catch (const scene::SceneError&) {
    throw;
  } catch (const std::exception& error) {
    throw scene::SceneError(where + ": " + error.what());
  }
}

std::unique_ptr<SystemNode> make_node(const ros::NodeHandle& node, const SystemConfiguration& configuration) {
  const std::shared_ptr<SystemPlugin> system = find_system(configuration.system);
  refusing("values", [&] {
    for (const auto& [name, value] : configuration.values) system->set(name, value);
  });
  return refusing(configuration.system,
                  [&] { return std::make_unique<SystemNode>(node, configuration, system); });
}

void run(const ros::NodeHandle& node) {
  const auto configuration = read_system_configuration(private_parameters(node));
  const auto system = make_node(node, configuration);
  ROS_INFO("system: %s; accuracy %g; %g Hz", configuration.system.c_str(), configuration.accuracy,
           configuration.adjustable.rate);
  system->run();
}

std::string hint(const ros::NodeHandle& node) {
  if (node.hasParam("system")) return "";
  return "; for a system type: roslaunch hybrid_sphere plant.launch system:=chaplygin_sleigh";
}

}  // namespace

int run_system(int argc, char** argv) {
  return run_node(argc, argv, {"three_stage_node", "three_stage", "system", run, hint});
}

}  // namespace hybrid_sphere::ros_interface
