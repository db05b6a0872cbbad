#include "ros/node/run_simulator.hpp"

#include <ros/package.h>

#include <string>
#include <string_view>

#include "ros/node/run_node.hpp"
#include "ros/node/scene_file.hpp"
#include "ros/node/simulator_node.hpp"
#include "scene/tree_place.hpp"

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
  const bool has_scene = node.hasParam("sphere") || node.hasParam("scene_file");
  return has_scene ? "" : "; for a scene type: roslaunch hybrid_sphere sim.launch scene:=paper";
}

const scene::Tree* find(const scene::Tree& map, std::string_view key) {
  const auto entries = map.as_map();
  return entries ? entries->find(key) : nullptr;
}

/// dynamic_reconfigure leaves ~accuracy on the parameter server, also for a run with another scene.
void warn_of_accuracy(const scene::Tree& parameters) {
  const scene::Tree own = scene::at_place(parameters, {std::string("accuracy")});
  const scene::Tree of_scene = scene::at_place(parameters, {std::string("solver"), std::string("accuracy")});
  if (own.as_number() && of_scene.as_number() && *own.as_number() != *of_scene.as_number()) {
    ROS_WARN("accuracy: %g overrides the scene's solver.accuracy: %g", *own.as_number(),
             *of_scene.as_number());
  }
}

/// Other nodes find the scene among the parameters, as if it had been set there.
/// @param before   what an earlier run has written of its file
/// @param of_file  the keys of the file
/// @param by_hand  the parameters without what an earlier run has written
/// @param all      the keys of the file with what is set by hand
void write_parameters(const ros::NodeHandle& node, const scene::Tree& before, const scene::Tree& of_file,
                      const scene::Tree& by_hand, const scene::Tree& all) {
  constexpr std::size_t most = 1U << 20U;  // bytes of a key: a large map would keep the master busy
  scene::Tree::Map written;
  const scene::Tree keys = merged(before, of_file);
  const scene::Tree::MapView entries = *keys.as_map();
  for (const auto& entry : entries) {
    const std::string key(entry.key);
    const scene::Tree* of_key = find(of_file, key);
    const bool is_small = of_key != nullptr && scene::to_yaml(*find(all, key)).size() <= most;
    if (is_small) written.emplace_back(key, *of_key);
    const scene::Tree* value = find(is_small ? all : by_hand, key);
    if (value != nullptr) node.setParam(key, parameters_from_tree(*value));
    if (value == nullptr) node.deleteParam(key);
  }
  node.setParam(written_parameter, parameters_from_tree(written));
}

}  // namespace

Configuration configuration_of(const ros::NodeHandle& node) {
  const scene::Tree given = private_parameters(node);
  const scene::Tree none{scene::Tree::Map{}};
  const scene::Tree* written = find(given, written_parameter);
  const scene::Tree before = written == nullptr ? none : *written;
  const scene::Tree by_hand = without(given, before);
  scene::Tree of_file = none;
  if (const scene::Tree* name = find(by_hand, "scene_file")) {
    const scene::Tree directory = scene::at_place(by_hand, {std::string("working_directory")});
    const std::string config = ros::package::getPath("hybrid_sphere") + "/config";
    const auto file = find_scene_file(*name, std::string(directory.as_text().value_or("")), config);
    ROS_INFO("scene file: %s", file.c_str());
    of_file = read_scene_keys(file);
  }
  const scene::Tree all = merged(of_file, by_hand);
  warn_of_accuracy(all);
  const Configuration configuration = read_configuration(all);
  for (const std::string& warning : configuration.scene.warnings) ROS_WARN("%s", warning.c_str());
  const bool is_written = before.as_map()->size() + of_file.as_map()->size() > 0;
  if (is_written) write_parameters(node, before, of_file, by_hand, all);
  return configuration;
}

int run_simulator(int argc, char** argv) {
  return run_node(argc, argv, {"hybrid_sphere_node", "hybrid_sphere", "scene", run, hint});
}

}  // namespace hybrid_sphere::ros_interface
