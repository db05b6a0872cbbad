#pragma once

#include <cstddef>
#include <string>

#include "scene/tree.hpp"

namespace hybrid_sphere::scene {

/// Limits of a scene file: anything larger is refused before it can exhaust memory. Reading a file within
/// them takes at most 100 MB, the tree included, whatever its content.
struct YamlLimits {
  std::size_t bytes = 32U << 20U;       ///< of the file
  std::size_t depth = 16;               ///< of nested lists and maps
  std::size_t values = 4'000'000;       ///< of the tree, with aliases written out
  std::size_t memory = 88'000'000;      ///< of the tree while it is built [bytes]
  std::size_t one_value = 1U << 20U;    ///< bytes of the file from one value, key or bracket to the next
  std::size_t first_value = 1U << 16U;  ///< bytes of the file before the first of them
};

/// @throws SceneError  if the text is not a single YAML document within the limits
Tree tree_from_yaml(const std::string& text, const YamlLimits& limits = {});

/// @throws SceneError  also if the file cannot be read
Tree tree_from_yaml_file(const std::string& path, const YamlLimits& limits = {});

}  // namespace hybrid_sphere::scene
