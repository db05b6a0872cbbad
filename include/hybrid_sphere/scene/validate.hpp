#pragma once

#include "hybrid_sphere/export.hpp"
#include "hybrid_sphere/scene/scene.hpp"
#include "hybrid_sphere/scene/scene_error.hpp"

namespace hybrid_sphere::scene {

/// Refuses a scene that no scene file could describe: numbers that are not finite or out of range, a
/// quaternion whose length is not 1 to within 1 %, coefficients that a law does not have, polygons that cross
/// themselves or run clockwise, unprintable or duplicate names, friction without a normal force. Scenes from
/// the readers of read_scene.hpp are valid. Source of the ranges: docs/scene_files.md.
/// @throws SceneError  with the key's full path, the value and the allowed range
/// @code
/// scene::Scene scene{};
/// scene.sphere.mass = -1;
/// try {
///   scene::validate(scene);
/// } catch (const scene::SceneError& error) {
///   // sphere.mass: -1 is refused; allowed: a number from 1e-60 to 1e+60 [kg]
/// }
/// @endcode
HYBRID_SPHERE_EXPORT void validate(const Scene& scene);

}  // namespace hybrid_sphere::scene
