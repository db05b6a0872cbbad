// Any text is a scene or is refused with a SceneError.

#include "scene/read_tree.hpp"
#include "scene/yaml.hpp"
#include "target.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace hybrid_sphere;
  try {
    scene::read_scene(scene::tree_from_yaml(std::string(reinterpret_cast<const char*>(data), size)));
  } catch (const scene::SceneError&) {
  }
  return 0;
}
