#include "ros/system/system_parameters.hpp"

#include <algorithm>
#include <array>

#include "hybrid_sphere/scene/scene_error.hpp"
#include "scene/map_reader.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

using scene::SceneError;
using scene::Tree;

constexpr scene::Range accuracy_range{mechanics::least_accuracy, mechanics::greatest_accuracy, ""};
constexpr scene::Range duration_range{1e-9, 1e12, "[s]"};
constexpr std::array<const char*, 20> all_keys{"system",
                                               "values",
                                               "duration",
                                               "accuracy",
                                               "rate",
                                               "real_time_factor",
                                               "paused",
                                               "clock",
                                               "clock_rate",
                                               "clock_jump_back",
                                               "publish_clock",
                                               "wait_for_viewer",
                                               "diagnostics",
                                               "diagnostic_period",
                                               "world_frame",
                                               "realtime_priority",
                                               "frame_prefix",
                                               "catch_up",
                                               "command_timeout",
                                               "command_timeout_clock"};

std::string listed() {
  std::string names;
  for (const char* key : all_keys) names += (names.empty() ? "" : ", ") + std::string(key);
  return names;
}

std::vector<std::pair<std::string, double>> read_values(const Tree& tree) {
  const auto map = tree.as_map();
  if (!map) throw SceneError("values", tree.describe(), "a map of numbers of the system");
  std::vector<std::pair<std::string, double>> values;
  for (const auto& [key, value] : *map) {
    const auto number = value.as_number();
    const std::string name(key);
    if (!number) throw SceneError("values." + name, value.describe(), "a number");
    values.emplace_back(name, *number);
  }
  return values;
}

std::string read_name(const Tree& tree) {
  const auto name = tree.as_text();
  if (!name || name->empty()) throw SceneError("system", tree.describe(), "the name of a system");
  return std::string(*name);
}

/// The beginning of a frame's name, or nothing.
std::string read_prefix(const Tree& tree, const std::string& path) {
  const auto text = tree.as_text();
  return text && text->empty() ? "" : read_frame(tree, path);
}

}  // namespace

SystemConfiguration read_system_configuration(const Tree& tree) {
  SystemConfiguration configuration;
  Tree::Map of_node;
  if (const auto map = tree.as_map()) {
    for (const auto& [key, value] : *map) {
      const std::string name(key);
      if (std::find(all_keys.begin(), all_keys.end(), name) == all_keys.end())
        throw SceneError(name, value.describe(), listed());
      if (name == "system") {
        configuration.system = read_name(value);
      } else if (name == "values") {
        configuration.values = read_values(value);
      } else if (name == "accuracy") {
        configuration.accuracy = scene::read_number(value, name, accuracy_range);
      } else if (name == "duration") {
        configuration.duration = scene::read_number(value, name, duration_range);
      } else if (name == "world_frame") {
        configuration.world_frame = read_frame(value, name);
      } else if (name == "frame_prefix") {
        configuration.frame_prefix = read_prefix(value, name);
      } else {
        of_node.emplace_back(name, value);
      }
    }
  }
  if (configuration.system.empty()) throw SceneError::missing("system", "the name of a system");
  const bool times_out = std::any_of(of_node.begin(), of_node.end(),
                                     [](const auto& entry) { return entry.first == "command_timeout"; });
  const NodeParameters node = read_node_parameters(of_node);
  if (times_out) configuration.command_timeout = node.command_timeout;
  configuration.time = node;
  configuration.adjustable = node.adjustable;
  return configuration;
}

}  // namespace hybrid_sphere::ros_interface
