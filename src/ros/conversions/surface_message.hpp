#pragma once

#include <hybrid_sphere/SurfaceMap.h>

#include <cstddef>

#include "hybrid_sphere/scene/scene.hpp"
#include "hybrid_sphere/scene/scene_error.hpp"
#include "ros/conversions/planar_transform.hpp"

namespace hybrid_sphere::ros_interface {

inline constexpr std::size_t max_map_regions = 1U << 20U;
inline constexpr std::size_t max_map_points = 4U << 20U;  ///< of all regions

/// The surface that a message stands for, validated as one of a scene file; paths of errors begin with "map".
/// @param to_world  takes coordinates of the message's frame, which is not looked at, to those of the world
/// @param forces    with which the ground must go: no friction without a normal force
/// @throws scene::SceneError  also for unknown enumerators, a z that is not 0, more regions or points than
///                            those; nothing was copied then
scene::Surface surface_from_message(const SurfaceMap& message, const PlanarTransform& to_world,
                                    const scene::Forces& forces);

/// The same surface as a message; its header is left to the caller. surface_from_message is its inverse.
SurfaceMap message_from_surface(const scene::Surface& surface);

}  // namespace hybrid_sphere::ros_interface
