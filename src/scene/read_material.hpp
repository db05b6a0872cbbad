#pragma once

#include <optional>

#include "hybrid_sphere/scene/scene.hpp"
#include "scene/map_reader.hpp"

namespace hybrid_sphere::scene {

/// The keys that read_material reads.
const Keys& material_keys();

/// The keys law, friction, rolling_resistance, spin_friction, belt and turntable of a map that also has other
/// keys.
/// @param default_law  used if there is no law; if empty, the key is required
/// @throws SceneError  also for a key that has no meaning for the law
Material read_material(const MapReader& keys, std::optional<Law> default_law = std::nullopt);

}  // namespace hybrid_sphere::scene
