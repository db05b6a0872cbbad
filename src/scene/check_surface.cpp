#include "scene/read_tree.hpp"

namespace hybrid_sphere::scene {

void check_material(const Material& material, const Forces& forces, const std::string& path) {
  const double z = forces.gravity.z();
  if (z < 0) return;
  const std::string only_while =
      " only while gravity presses the sphere on, gravity[2] < 0; it is " + Tree(z).describe();
  if (material.law == Law::coulomb) {
    throw SceneError(path + ".law", Tree(to_string(material.law)).describe(),
                     "smooth, rough, rubber; coulomb" + only_while);
  }
  if (material.rolling_resistance != 0) {
    throw SceneError(path + ".rolling_resistance", Tree(material.rolling_resistance).describe(),
                     "0; more" + only_while);
  }
  if (material.spin_friction != 0) {
    throw SceneError(path + ".spin_friction", Tree(material.spin_friction).describe(),
                     "0; more" + only_while);
  }
}

void check_surface(const Surface& surface, const Forces& forces, const std::string& path) {
  if (forces.gravity.z() < 0) return;
  check_material(surface.base, forces, path + ".base");
  for (std::size_t i = 0; i < surface.regions.size(); ++i) {
    const Material& material = surface.regions[i].material;
    if (i < surface.image_regions) {
      check_material(material, forces, path + ".image");
    } else {
      check_material(material, forces, path + ".regions[" + std::to_string(i - surface.image_regions) + "]");
    }
  }
}

}  // namespace hybrid_sphere::scene
