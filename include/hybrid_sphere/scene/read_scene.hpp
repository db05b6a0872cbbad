#pragma once

#include <string>
#include <string_view>

#include "hybrid_sphere/export.hpp"
#include "hybrid_sphere/scene/scene.hpp"
#include "hybrid_sphere/scene/scene_error.hpp"

/// Scenes as users write them (docs/scene_files.md), read and validated. Every function throws SceneError
/// with the key's full path, the value and the allowed range; unknown keys, wrong types, non-finite and
/// out-of-range values are refused.
namespace hybrid_sphere::scene {

/// The scene in a YAML file; relative names of images are relative to the file's directory.
HYBRID_SPHERE_EXPORT Scene read_scene_file(const std::string& file);

/// The scene in a YAML text.
/// @param base_directory  the directory to which relative image names refer; empty: the working directory
/// @code
/// const scene::Scene scene = scene::read_scene_text(
///     "sphere: {mass: 1, radius: 0.5, body: solid}\n"
///     "surface: {base: {law: coulomb, friction: 0.3}}\n");
/// @endcode
HYBRID_SPHERE_EXPORT Scene read_scene_text(std::string_view yaml, const std::string& base_directory = "");

}  // namespace hybrid_sphere::scene
