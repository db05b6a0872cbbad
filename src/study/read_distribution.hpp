#pragma once

#include <string>

#include "scene/tree.hpp"
#include "study/distribution.hpp"

namespace hybrid_sphere::study {

/// The distribution in a map of one key, as `{normal: {mean: 1, deviation: 0.05}}` (docs/studies.md).
/// @param path  of the map
/// @throws SceneError  with the key's full path, the value and what is allowed
Distribution read_distribution(const scene::Tree& tree, const std::string& path);

}  // namespace hybrid_sphere::study
