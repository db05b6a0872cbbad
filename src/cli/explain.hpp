#pragma once

#include <string>

#include "hybrid_sphere/scene/scene.hpp"

namespace hybrid_sphere::cli {

/// In words: what the scene requires, what is therefore not modelled, and which method was taken and why.
std::string explain(const scene::Scene& scene);

}  // namespace hybrid_sphere::cli
