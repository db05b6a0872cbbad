#pragma once

#include <XmlRpcValue.h>

#include <filesystem>
#include <string>

#include "scene/tree.hpp"

/// A scene that a node reads from a file itself, with the reader of `simulate`.
namespace hybrid_sphere::ros_interface {

/// Parameter in which a node keeps what it has written of its file, to tell it from what is set by hand.
inline constexpr const char* written_parameter = "from_scene_file";

/// The file that ~scene_file names: a scene of the package by its stem, or a path, which may begin with `~/`.
/// @param working_directory  to which a relative path refers; empty: that of the process
/// @param config             directory of the scenes of the package
/// @return                   absolute
/// @throws scene::SceneError  if there is no such file; lists the scenes of the package
std::filesystem::path find_scene_file(const scene::Tree& name, const std::string& working_directory,
                                      const std::filesystem::path& config);

/// The scene in the file as a map, and its directory under the key scene_directory.
/// @throws scene::SceneError  if the file is no YAML, or has a key that no scene has
scene::Tree read_scene_keys(const std::filesystem::path& file);

/// A map with the entries of another one put over it: maps are merged, any other value is replaced.
scene::Tree merged(const scene::Tree& under, const scene::Tree& over);

/// A map without the entries that another one has with the same value.
scene::Tree without(const scene::Tree& map, const scene::Tree& other);

/// The tree as the parameter server holds it; values that are null are left out.
XmlRpc::XmlRpcValue parameters_from_tree(const scene::Tree& tree);

}  // namespace hybrid_sphere::ros_interface
