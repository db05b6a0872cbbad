#include "ros/system/find_system.hpp"

#include <algorithm>
#include <pluginlib/class_loader.hpp>
#include <vector>

#include "catalogue/catalogue.hpp"
#include "hybrid_sphere/scene/scene_error.hpp"
#include "ros/system/catalogue_system.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

using Loader = pluginlib::ClassLoader<SystemPlugin>;

/// The library of a plugin stays loaded as long as its systems are there.
std::shared_ptr<SystemPlugin> load(const std::shared_ptr<Loader>& loader, const std::string& name) {
  SystemPlugin* system = nullptr;
  try {
    system = loader->createUnmanagedInstance(name);
  } catch (const pluginlib::PluginlibException&) {
    throw;
  } catch (const std::exception& error) {  // of a type that the library may take away with it
    throw scene::SceneError("system \"" + name + "\": " + error.what());
  }
  return {system, [loader](SystemPlugin* used) { delete used; }};
}

}  // namespace

std::shared_ptr<SystemPlugin> find_system(const std::string& name) {
  std::string known;
  for (const mechanics::catalogue::Entry& entry : mechanics::catalogue::entries()) {
    if (entry.name == name) return std::make_shared<CatalogueSystem>(entry);
    known += (known.empty() ? "" : ", ") + entry.name;
  }
  try {
    const auto loader = std::make_shared<Loader>("hybrid_sphere", "hybrid_sphere::SystemPlugin");
    const std::vector<std::string> plugins = loader->getDeclaredClasses();
    if (std::find(plugins.begin(), plugins.end(), name) != plugins.end()) return load(loader, name);
    for (const std::string& plugin : plugins) known += ", " + plugin;
  } catch (const pluginlib::PluginlibException& error) {
    throw scene::SceneError("system \"" + name + "\": the plugin cannot be loaded: " + error.what());
  }
  throw scene::SceneError("system", "\"" + name + "\"", known);
}

}  // namespace hybrid_sphere::ros_interface
