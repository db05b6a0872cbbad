#include "python/scene_of.hpp"

#include <filesystem>

#include "python/tree_of.hpp"
#include "scene/read_tree.hpp"
#include "scene/yaml.hpp"
#include "simulation/check_method.hpp"

namespace hybrid_sphere::python {
namespace {

bool is_yaml(const std::string& text) {
  return text.find('\n') != std::string::npos || text.find('{') == text.find_first_not_of(" \t");
}

}  // namespace

SceneSource source_of(const pybind11::handle& scene) {
  const scene::Tree tree = tree_of(scene);
  const auto text = tree.as_text();
  if (!text) return {tree, ""};
  const std::string name(*text);
  if (is_yaml(name)) return {scene::tree_from_yaml(name), ""};
  return {scene::tree_from_yaml_file(name), std::filesystem::path(name).parent_path().string()};
}

scene::Scene scene_of(const SceneSource& source) {
  scene::Scene scene = scene::read_scene(source.tree, source.directory);
  check_method(scene);
  return scene;
}

}  // namespace hybrid_sphere::python
