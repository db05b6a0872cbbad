#include "character_parts.hpp"

#include <string>
#include <utility>

#include "chance.hpp"
#include "support/random_scenes.hpp"

namespace hybrid_sphere::fuzz {

using scene::Material;
using testing::integer;

Vector2d vector(int size, double denominator) {
  return Vector2d(integer(-size, size), integer(-size, size)) / denominator;
}

void add(scene::Surface& surface, scene::Shape shape, const Material& material) {
  surface.regions.push_back({"region_" + std::to_string(surface.regions.size()), std::move(shape), material});
}

scene::Polygon box(const Vector2d& low, const Vector2d& high) {
  return {{low, {high.x(), low.y()}, high, {low.x(), high.y()}}, false};
}

Material any_material() {
  Material material = testing::random_material();
  if (material.law == scene::Law::coulomb && material.friction > 0 && chance(4))
    material.rolling_resistance = material.friction * integer(1, 16) / 16.0;
  return material;
}

scene::Scene sphere_on(scene::Surface surface) {
  scene::Scene any = testing::random_any_scene();
  any.surface = std::move(surface);
  return any;
}

}  // namespace hybrid_sphere::fuzz
