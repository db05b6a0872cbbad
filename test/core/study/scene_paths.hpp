#pragma once

#include <string>
#include <vector>

#include "scene/yaml.hpp"
#include "study/study_scene.hpp"

/// Scenes with numbers to vary, and what is said to paths of them.
namespace hybrid_sphere::testing {

using namespace study;

// Every kind of shape, law, ground motion and force.
inline const char* const rich_scene = R"(
sphere: {mass: 2, radius: 0.25, gyration_radius: 0.1}
initial_state:
  {position: [1, 2], velocity: [3, 4], angular_velocity: [5, 6, 7], orientation: [0.6, 0, 0.8, 0]}
gravity: [0.1, 0.2, -9]
wrench: {force: [1, 2], torque: [3, 4, 5]}
drag: {translational: 0.1, rotational: 0.2, quadratic: 0.3}
spring: {stiffness: 2, center: [1, 1]}
solver: {accuracy: 1e-8, step: 0.01}
surface:
  base: {law: coulomb, friction: 0.3, rolling_resistance: 0.01, spin_friction: 0.02, belt: [0.1, 0.2]}
  regions:
    - {name: half, half_plane: {point: [1, 2], normal: [0, 1]}, law: rough, rolling_resistance: 0.1, belt: [1, 0]}
    - {name: disc, circle: {center: [4, 5], radius: 2}, law: coulomb, friction: 0.4,
       turntable: {rate: 3, center: [4, 5]}}
    - {name: "odd.name[3]", circle: {center: [-4, 5], radius: 2}, outside: true, law: rubber}
    - {name: patch, polygon: [[0, 0], [1, 0], [1, 1], [0, 1]], law: smooth}
    - {name: reversed, polygon: [[0, 0], [0, -1], [-1, -1]], outside: true, law: rubber, belt: [0, 1]}
)";
// Only what a scene must have, and a body in place of the radius of gyration.
inline const char* const poor_scene =
    "{sphere: {mass: 2, radius: 0.25, body: solid}, surface: {base: {law: rough}, regions: [{name: spun, "
    "law: "
    "rough, turntable: {rate: 0, center: [1, 2]}, half_plane: {point: [0, 0], normal: [1, 0]}}]}}";

inline Study study_of(const std::string& scene, const std::vector<std::string>& paths) {
  Study study;
  study.scene_tree = scene::tree_from_yaml(scene);
  for (const std::string& path : paths) study.variables.push_back({path, Uniform{0.25, 0.75}, 1});
  return study;
}

/// What is said to a path.
inline std::string refusal(const std::string& scene, const std::string& path) {
  try {
    const Study study = study_of(scene, {path});
    SceneVariation variation = variation_of(study);
  } catch (const scene::SceneError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace hybrid_sphere::testing
