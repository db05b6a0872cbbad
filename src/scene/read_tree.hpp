#pragma once

#include <string>
#include <vector>

#include "hybrid_sphere/scene/scene.hpp"
#include "scene/tree.hpp"

/// The only parser and validator of scenes. Every function throws SceneError with the key's full path, the
/// value and the allowed range; unknown keys, wrong types, non-finite and out-of-range values are refused,
/// keys of features that do not exist yet are refused as "not supported yet".
namespace hybrid_sphere::scene {

class MapReader;

/// The whole scene: keys sphere, initial_state, surface, gravity, wrench, drag, spring, solver.
/// @param base_directory  the directory to which relative image names refer; empty: the working directory
/// @param beside          keys besides the scene's, which the caller has taken out: listed when a key is
/// unknown
Scene read_scene(const Tree& tree, const std::string& base_directory = "",
                 const std::vector<const char*>& beside = {});

/// The keys that a scene may have.
const std::vector<const char*>& scene_keys();

/// @param path  put before the keys in error messages
SphereBody read_sphere(const Tree& tree, const std::string& path = "sphere");
InitialState read_initial_state(const Tree& tree, const std::string& path = "initial_state");
/// @param warnings  gets what is ignored, if not null
Surface read_surface(const Tree& tree, const std::string& path = "surface",
                     const std::string& base_directory = "", std::vector<std::string>* warnings = nullptr);
Solver read_solver(const Tree& tree, const std::string& path = "solver");

/// The keys gravity, wrench, drag and spring of a map that also has other keys. The sphere bounds them: none
/// of its accelerations may exceed the range of the velocities.
Forces read_forces(const MapReader& keys, const SphereBody& sphere);
Wrench read_wrench(const Tree& tree, const SphereBody& sphere, const std::string& path = "wrench");

}  // namespace hybrid_sphere::scene
