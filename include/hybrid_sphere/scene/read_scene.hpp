#pragma once

#include "hybrid_sphere/scene/scene.hpp"
#include "hybrid_sphere/scene/tree.hpp"

/// The one parser and validator of scenes. Every function throws SceneError with the key's full path, the
/// value and the allowed range; unknown keys, wrong types, non-finite and out-of-range values are refused,
/// keys of features that do not exist yet are refused as "not supported yet".
namespace hybrid_sphere::scene {

/// The whole scene: keys sphere, initial_state, surface, solver.
Scene read_scene(const Tree& tree);

/// @param path  put before the keys in error messages
SphereBody read_sphere(const Tree& tree, const std::string& path = "sphere");
InitialState read_initial_state(const Tree& tree, const std::string& path = "initial_state");
Surface read_surface(const Tree& tree, const std::string& path = "surface");
Solver read_solver(const Tree& tree, const std::string& path = "solver");

}  // namespace hybrid_sphere::scene
