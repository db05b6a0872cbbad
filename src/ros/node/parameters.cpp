#include "ros/node/parameters.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "ros/node/scene_file.hpp"
#include "scene/map_reader.hpp"
#include "scene/read_tree.hpp"
#include "scene/yaml.hpp"
#include "simulation/check_method.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

using scene::SceneError;
using scene::Tree;
using XmlRpc::XmlRpcValue;

constexpr scene::Range rate_range{1e-3, 1e6, "[Hz]"};
constexpr scene::Range factor_range{least_real_time_factor, 1e3, ""};
constexpr scene::Range clock_range{1e-3, 1e4, "[Hz]"};
constexpr scene::Range diagnostic_range{1e-2, 1e6, "[s]"};
constexpr scene::Range timeout_range{0, 1e9, "[s]"};
constexpr scene::Range kick_range{0, 1e3, "[m/s]"};
constexpr scene::Range side_range{0, 1e15, "[m]"};
constexpr scene::Range threshold_range{1, 100, "[%]"};
constexpr scene::Range accuracy_range{1e-14, 1, ""};
constexpr scene::Range trail_range{0, 100000, ""};
constexpr scene::Range lifetime_range{0, 1e6, "[s]"};
constexpr scene::Range arrow_range{0, 100, ""};
constexpr scene::Range wait_range{0, 3600, "[s]"};
constexpr scene::Range priority_range{0, 99, ""};
constexpr std::array<const char*, 28> own_keys{"rate",
                                               "real_time_factor",
                                               "accuracy",
                                               "trail_length",
                                               "impulse_lifetime",
                                               "arrow_scale",
                                               "paused",
                                               "publish_clock",
                                               "clock_rate",
                                               "diagnostics",
                                               "world_frame",
                                               "sphere_frame",
                                               "command_timeout",
                                               "grid_threshold",
                                               "scene_directory",
                                               "scene_file",
                                               "working_directory",
                                               written_parameter,
                                               "kick",
                                               "ground_side",
                                               "realtime_priority",
                                               "clock",
                                               "clock_jump_back",
                                               "wait_for_viewer",
                                               "catch_up",
                                               "command_timeout_clock",
                                               "diagnostic_period",
                                               "rviz_tools"};
constexpr std::size_t longest_frame = 100;

std::string joined(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

/// Whether YAML 1.1, as PyYAML reads it, takes the text of a decimal number for a number.
/// Source: https://yaml.org/type/float.html, int.html
bool is_yaml_1_1_number(const std::string& text) {
  const std::size_t mark = text.find_first_of("eE");
  const std::string mantissa = text.substr(0, mark);
  const bool has_sign = mark == std::string::npos || text[mark + 1] == '+' || text[mark + 1] == '-';
  const std::size_t point = mantissa.find('.');
  const bool begins_with_digit = point != mantissa.find_first_not_of("+-");
  if (point == std::string::npos) return mark == std::string::npos;
  return has_sign && (begins_with_digit || point == 0);
}

/// A scene file's number that YAML 1.1 takes for text, such as 1e-9, is a number here, too: what sets the
/// parameters does not say whether it was quoted. The node's own parameters are at the depth 2.
Tree convert_text(const std::string& text, std::size_t depth) {
  constexpr std::size_t own_depth = 2;
  if (depth <= own_depth || is_yaml_1_1_number(text)) return text;
  if (const auto number = scene::parse_number(text)) return *number;
  return text;
}

Tree convert(XmlRpcValue& value, const std::string& path, std::size_t depth) {
  const std::size_t deepest = scene::YamlLimits{}.depth;
  if (depth > deepest) {
    throw SceneError(path, "a value nested deeper", "at most " + std::to_string(deepest) + " levels");
  }
  switch (value.getType()) {
    case XmlRpcValue::TypeInvalid: return {};
    case XmlRpcValue::TypeBoolean: return static_cast<bool>(value);
    case XmlRpcValue::TypeInt: return static_cast<double>(static_cast<int>(value));
    case XmlRpcValue::TypeDouble: return static_cast<double>(value);
    case XmlRpcValue::TypeString: return convert_text(value, depth);
    case XmlRpcValue::TypeArray: {
      Tree::List list;
      for (int i = 0; i < value.size(); ++i) {
        list.push_back(convert(value[i], path + "[" + std::to_string(i) + "]", depth + 1));
      }
      return list;
    }
    case XmlRpcValue::TypeStruct: {
      Tree::Map map;
      for (auto& [key, item] : value) map.emplace_back(key, convert(item, joined(path, key), depth + 1));
      return map;
    }
    case XmlRpcValue::TypeDateTime:
    case XmlRpcValue::TypeBase64: break;
  }
  const char* kind = value.getType() == XmlRpcValue::TypeDateTime ? "a date" : "binary data";
  throw SceneError(path, kind, "numbers, text, true, false, lists and maps");
}

/// @throws scene::SceneError  for what is neither 0 nor within the range
double read_zero_or(const scene::Range& range, const Tree& tree, const std::string& path) {
  const auto value = tree.as_number();
  if (value && *value == 0) return 0;
  try {
    return scene::read_number(tree, path, range);
  } catch (const SceneError&) {
    throw SceneError(path, tree.describe(), "0, or " + range.describe());
  }
}

std::string read_directory(const Tree& tree, const std::string& path) {
  const auto name = tree.as_text();
  if (!name) throw SceneError(path, tree.describe(), "the path of a directory, or empty");
  return std::string(*name);
}

int read_count(const Tree& tree, const std::string& path, const scene::Range& range) {
  const double value = scene::read_number(tree, path, range);
  if (value != std::floor(value))
    throw SceneError(path, tree.describe(), range.describe() + " without a fractional part");
  return static_cast<int>(value);
}

/// One of some words.
template <class Value>
Value read_word(const Tree& tree, const std::string& path,
                const std::vector<std::pair<const char*, Value>>& words) {
  const auto text = tree.as_text();
  std::string allowed;
  for (const auto& [word, value] : words) {
    if (text && *text == word) return value;
    allowed += (allowed.empty() ? "" : ", ") + std::string(word);
  }
  throw SceneError(path, tree.describe(), allowed);
}

/// `publish_clock` is the older word for `clock: lead`.
void read_clock(const Tree::Map& keys, NodeParameters& node) {
  bool is_given = false;
  for (const auto& [key, value] : keys) {
    if (key != "clock") continue;
    node.clock = read_word<ClockMode>(
        value, key, {{"own", ClockMode::own}, {"lead", ClockMode::lead}, {"follow", ClockMode::follow}});
    is_given = true;
  }
  for (const auto& [key, value] : keys) {
    if (key == "clock_jump_back")
      node.resets_on_jump_back = read_word<bool>(value, key, {{"reset", true}, {"hold", false}});
    if (key != "publish_clock" || !scene::read_flag(value, key)) continue;
    if (is_given && node.clock != ClockMode::lead)
      throw SceneError(key, value.describe(), "false where clock is not lead");
    node.clock = ClockMode::lead;
  }
  if (node.clock == ClockMode::follow && node.adjustable.real_time_factor != 1) {
    throw SceneError("real_time_factor", Tree(node.adjustable.real_time_factor).describe(),
                     "1 with clock: follow");
  }
}

/// Takes one of those keys.
void read_adjustable(const std::string& key, const Tree& value, Adjustable& adjustable) {
  if (key == "rate") adjustable.rate = scene::read_number(value, key, rate_range);
  if (key == "real_time_factor") adjustable.real_time_factor = read_zero_or(factor_range, value, key);
  if (key == "accuracy") adjustable.accuracy = scene::read_number(value, key, accuracy_range);
  MarkerStyle& markers = adjustable.markers;
  if (key == "trail_length") markers.trail_length = read_count(value, key, trail_range);
  if (key == "impulse_lifetime") markers.impulse_lifetime = scene::read_number(value, key, lifetime_range);
  if (key == "arrow_scale") markers.arrow_scale = scene::read_number(value, key, arrow_range);
}

}  // namespace

std::string read_frame(const Tree& tree, const std::string& path) {
  const std::string allowed =
      "the name of a frame: 1 to " + std::to_string(longest_frame) + " characters, no whitespace";
  const auto text = tree.as_text();
  // tf2 has no leading slash, which launch files for ROS's older tf have.
  const auto name = text && text->rfind('/', 0) == 0 ? text->substr(1) : text;
  const auto is_blank = [](char c) { return static_cast<unsigned char>(c) <= 0x20 || c == 0x7f; };
  if (!name || name->empty() || name->size() > longest_frame || name->front() == '/' ||
      std::any_of(name->begin(), name->end(), is_blank)) {
    throw SceneError(path, tree.describe(), allowed);
  }
  return std::string(*name);
}

NodeParameters read_node_parameters(const Tree::Map& keys) {
  NodeParameters node;
  for (const auto& [key, value] : keys) {
    read_adjustable(key, value, node.adjustable);
    if (key == "paused") node.paused = scene::read_flag(value, key);
    if (key == "wait_for_viewer") node.wait_for_viewer = scene::read_number(value, key, wait_range);
    if (key == "clock_rate") node.clock_rate = read_zero_or(clock_range, value, key);
    if (key == "catch_up") node.catches_up = scene::read_flag(value, key);
    if (key == "command_timeout_clock")
      node.inputs_age_by_wall = read_word<bool>(value, key, {{"simulated", false}, {"wall", true}});
    if (key == "diagnostic_period") node.diagnostic_period = scene::read_number(value, key, diagnostic_range);
    if (key == "rviz_tools") node.rviz_tools = scene::read_flag(value, key);
    if (key == "diagnostics") node.diagnostics = scene::read_flag(value, key);
    if (key == "command_timeout") node.command_timeout = scene::read_number(value, key, timeout_range);
    if (key == "kick") node.kick = scene::read_number(value, key, kick_range);
    if (key == "ground_side") node.ground_side = scene::read_number(value, key, side_range);
    if (key == "realtime_priority") node.realtime_priority = read_count(value, key, priority_range);
    if (key == "grid_threshold") node.grid_threshold = scene::read_number(value, key, threshold_range);
    if (key == "scene_directory") node.scene_directory = read_directory(value, key);
    if (key == "working_directory") node.working_directory = read_directory(value, key);
    if (key == "world_frame") node.frames.world = read_frame(value, key);
    if (key == "sphere_frame") node.frames.sphere = read_frame(value, key);
  }
  read_clock(keys, node);
  if (node.frames.world == node.frames.sphere) {
    throw SceneError("sphere_frame", Tree(node.frames.sphere).describe(), "a name other than world_frame's");
  }
  return node;
}

Tree tree_from_parameters(const XmlRpcValue& value, const std::string& path) {
  XmlRpcValue copy = value;  // its accessors are not const
  return convert(copy, path, 1);
}

Configuration read_configuration(const Tree& tree) {
  const auto map = tree.as_map();
  if (!map) return {NodeParameters{}, scene::read_scene(tree)};  // refused: no key is there
  Tree::Map own;
  Tree::Map scene_keys;
  for (const auto& [key, value] : *map) {
    const bool is_own = std::find(own_keys.begin(), own_keys.end(), key) != own_keys.end();
    (is_own ? own : scene_keys).emplace_back(key, value);
  }
  const NodeParameters node = read_node_parameters(own);
  Configuration configuration{
      node, scene::read_scene(scene_keys, node.scene_directory, {own_keys.begin(), own_keys.end()})};
  double& accuracy = configuration.scene.solver.accuracy;
  const auto is_accuracy = [](const auto& entry) { return entry.first == "accuracy"; };
  if (std::any_of(own.begin(), own.end(), is_accuracy)) accuracy = node.adjustable.accuracy;
  configuration.node.adjustable.accuracy = accuracy;
  check_method(configuration.scene);
  return configuration;
}

}  // namespace hybrid_sphere::ros_interface
