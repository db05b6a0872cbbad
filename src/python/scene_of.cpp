#include "python/scene_of.hpp"

#include <filesystem>

#include "python/interpreter_lock.hpp"
#include "python/tree_of.hpp"
#include "scene/printable.hpp"
#include "scene/read_tree.hpp"
#include "scene/yaml.hpp"
#include "simulation/check_method.hpp"

namespace hybrid_sphere::python {
namespace {

bool is_yaml(const std::string& text) {
  return text.find('\n') != std::string::npos || text.find('{') == text.find_first_not_of(" \t");
}

scene::Scene read(const SceneSource& source) {
  const WithoutLock unlocked;
  scene::Scene scene = scene::read_scene(source.tree, source.directory);
  check_method(scene);
  return scene;
}

}  // namespace

SceneSource source_of(const pybind11::handle& scene) {
  const scene::Tree tree = tree_of(scene);
  const auto text = tree.as_text();
  if (!text) return {tree, ""};
  const std::string name(*text);
  const WithoutLock unlocked;  // no object of Python from here on
  if (is_yaml(name)) return {scene::tree_from_yaml(name), ""};
  if (name.find('\0') != std::string::npos) {
    throw scene::SceneError("scene", '"' + scene::printable(name) + '"', "a name of a file without a NUL");
  }
  return {scene::tree_from_yaml_file(name), std::filesystem::path(name).parent_path().string()};
}

scene::Scene scene_of(const SceneSource& source) {
  scene::Scene scene = read(source);
  for (const std::string& warning : scene.warnings) {
    if (PyErr_WarnEx(PyExc_UserWarning, warning.c_str(), 1) != 0) throw pybind11::error_already_set();
  }
  return scene;
}

}  // namespace hybrid_sphere::python
