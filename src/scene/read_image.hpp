#pragma once

#include <string>
#include <vector>

#include "hybrid_sphere/scene/scene.hpp"
#include "scene/tree.hpp"

namespace hybrid_sphere::scene {

/// The regions that an image's cells make: image_0, image_1 ... (docs/scene_files.md).
/// @param path            put before the keys in error messages
/// @param base_directory  what relative names of files are relative to; empty: the working directory
/// @throws SceneError     also when the image cannot be read
std::vector<Region> read_image(const Tree& tree, const std::string& path, const std::string& base_directory);

}  // namespace hybrid_sphere::scene
