#pragma once

#include <iosfwd>

#include "hybrid_sphere/scene/scene.hpp"

namespace hybrid_sphere::testing {

/// As in a scene file, for the log of a failed property.
std::ostream& operator<<(std::ostream& out, const scene::Shape& shape);
std::ostream& operator<<(std::ostream& out, const scene::Material& material);
std::ostream& operator<<(std::ostream& out, const scene::Scene& scene);

}  // namespace hybrid_sphere::testing
