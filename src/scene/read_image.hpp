#pragma once

#include <string>
#include <vector>

#include "hybrid_sphere/scene/scene.hpp"
#include "scene/tree.hpp"

namespace hybrid_sphere::scene {

/// The regions made of an image's cells: image_0, image_1 ... (docs/scene_files.md).
/// @param path            put before the keys in error messages
/// @param base_directory  the directory to which relative file names refer; empty: the working directory
/// @param warnings        gets what is ignored
/// @throws SceneError     also if the image cannot be read
std::vector<Region> read_image(const Tree& tree, const std::string& path, const std::string& base_directory,
                               std::vector<std::string>& warnings);

}  // namespace hybrid_sphere::scene
