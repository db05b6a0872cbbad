#pragma once

#include <string>

#include "hybrid_sphere/scene/scene.hpp"

namespace hybrid_sphere::cli {

/// In words: what the scene requires, what is therefore not modelled, and which method was taken and why.
/// @param orientation  whether an output wants it
std::string explain(const scene::Scene& scene, bool orientation = true);

}  // namespace hybrid_sphere::cli
