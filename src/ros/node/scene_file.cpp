#include "ros/node/scene_file.hpp"

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "scene/map_reader.hpp"
#include "scene/read_tree.hpp"
#include "scene/tree_place.hpp"
#include "scene/yaml.hpp"
#include "text/nearest.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

namespace files = std::filesystem;
using scene::SceneError;
using scene::Tree;

constexpr const char* key_of_file = "scene_file";

bool is_yaml(const files::path& file) { return file.extension() == ".yaml" || file.extension() == ".yml"; }

/// Sorted.
std::vector<std::string> scenes_in(const files::path& config) {
  std::vector<std::string> stems;
  std::error_code missing;
  for (const auto& entry : files::directory_iterator(config, missing)) {
    if (is_yaml(entry.path())) stems.push_back(entry.path().stem().string());
  }
  std::sort(stems.begin(), stems.end());
  return stems;
}

std::string allowed_scenes(const std::vector<std::string>& scenes) {
  std::string list;
  for (const std::string& scene : scenes) list += (list.empty() ? "" : ", ") + scene;
  return "the path of a file" + (list.empty() ? "" : ", or a scene of the package: " + list);
}

[[noreturn]] void refuse(const Tree& name, const std::string& why, const files::path& config) {
  const std::vector<std::string> scenes = scenes_in(config);
  std::string question;
  if (const auto text = name.as_text(); text && !text->empty() && !scenes.empty()) {
    const std::string& meant = text::nearest(*text, scenes);
    const std::size_t few = std::max<std::size_t>(1, text->size() / 3);
    if (text::distance_of(*text, meant) <= few) question = "; did you mean " + meant + "?";
  }
  const std::string reason = why.empty() && question.empty() ? "" : " (" + why + question + ")";
  throw SceneError(key_of_file, name.describe() + reason, allowed_scenes(scenes));
}

/// A shell leaves the tilde of scene:=~/s.yaml as it is.
files::path with_home(const std::string& name) {
  const char* home = std::getenv("HOME");
  if (home == nullptr || (name != "~" && name.rfind("~/", 0) != 0)) return name;
  return home + name.substr(1);
}

}  // namespace

files::path find_scene_file(const Tree& name, const std::string& working_directory,
                            const files::path& config) {
  const auto text = name.as_text();
  if (!text || text->empty() || text->find('\0') != std::string_view::npos) refuse(name, "no name", config);
  const std::string given(*text);
  if (given.find('/') == std::string::npos && !is_yaml(given)) {
    for (const char* ending : {".yaml", ".yml"}) {
      const files::path file = config / (given + ending);
      if (files::exists(file)) return files::absolute(file);
    }
  }
  const files::path directory =
      working_directory.empty() ? files::current_path() : files::absolute(working_directory);
  const files::path file = (directory / with_home(given)).lexically_normal();
  std::error_code unknown;
  if (!files::exists(file, unknown)) refuse(name, "there is no file " + file.string(), config);
  return file;
}

Tree read_scene_keys(const files::path& file) {
  const Tree tree = scene::tree_from_yaml_file(file.string());
  const scene::MapReader keys(tree, "", scene::scene_keys());
  return scene::with_value(tree, {std::string("scene_directory")}, Tree(file.parent_path().string()));
}

Tree merged(const Tree& under, const Tree& over) {
  const auto below = under.as_map();
  const auto above = over.as_map();
  if (!below || !above) return over;
  Tree::Map entries;
  for (const auto& [key, value] : *below) {
    const Tree* other = above->find(key);
    entries.emplace_back(std::string(key), other == nullptr ? value : merged(value, *other));
  }
  for (const auto& [key, value] : *above) {
    if (below->find(key) == nullptr) entries.emplace_back(std::string(key), value);
  }
  return entries;
}

Tree without(const Tree& map, const Tree& other) {
  const auto entries = map.as_map();
  const auto others = other.as_map();
  if (!entries || !others) return map;
  Tree::Map kept;
  for (const auto& [key, value] : *entries) {
    const Tree* same = others->find(key);
    if (same != nullptr && scene::to_yaml(value) == scene::to_yaml(*same)) continue;
    kept.emplace_back(std::string(key), same == nullptr ? value : without(value, *same));
  }
  return kept;
}

XmlRpc::XmlRpcValue parameters_from_tree(const Tree& tree) {
  if (const auto flag = tree.as_bool()) return XmlRpc::XmlRpcValue(*flag);
  if (const auto number = tree.as_number()) return XmlRpc::XmlRpcValue(*number);
  if (const auto text = tree.as_text()) return XmlRpc::XmlRpcValue(std::string(*text));
  XmlRpc::XmlRpcValue value;
  if (const auto list = tree.as_list()) {
    value.setSize(static_cast<int>(list->size()));
    for (std::size_t i = 0; i < list->size(); ++i)
      value[static_cast<int>(i)] = parameters_from_tree((*list)[i]);
  }
  if (const auto map = tree.as_map()) {
    for (const auto& [key, item] : *map) {
      if (!item.is_null()) value[std::string(key)] = parameters_from_tree(item);
    }
  }
  return value;
}

}  // namespace hybrid_sphere::ros_interface
