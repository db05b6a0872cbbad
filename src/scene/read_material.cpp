#include "scene/read_material.hpp"

namespace hybrid_sphere::scene {
namespace {

Law read_law(const MapReader& keys, std::optional<Law> default_law) {
  const Tree* tree = keys.find("law");
  if (!tree && default_law) return *default_law;
  if (!tree) throw SceneError::missing(keys.path_of("law"), "smooth, rough, rubber, coulomb");
  const std::string word = read_word(*tree, keys.path_of("law"), {"smooth", "rough", "rubber", "coulomb"});
  for (const Law law : {Law::smooth, Law::rough, Law::rubber}) {
    if (word == to_string(law)) return law;
  }
  return Law::coulomb;
}

double read_coefficient(const MapReader& keys, const char* key) {
  const Tree* value = keys.find(key);
  return value ? read_number(*value, keys.path_of(key), coefficient_range) : 0;
}

void read_coefficients(const MapReader& keys, Material& material) {
  const Law law = material.law;
  if (law == Law::coulomb) {
    const Tree& friction = keys.require("friction", "the coefficient of the law coulomb, 0 to 1e+09");
    material.friction = read_number(friction, keys.path_of("friction"), coefficient_range);
  } else {
    keys.refuse("friction", "only the law coulomb has a coefficient of friction");
  }
  if (law == Law::smooth) {
    keys.refuse("rolling_resistance", "nothing rolls on smooth ground");
    keys.refuse("spin_friction", "smooth ground has no friction");
    return;
  }
  material.rolling_resistance = read_coefficient(keys, "rolling_resistance");
  if (law == Law::rubber) {
    keys.refuse("spin_friction", "the law rubber leaves no spin relative to the ground for it to act on");
  } else {
    material.spin_friction = read_coefficient(keys, "spin_friction");
  }
}

void read_turntable(const Tree& tree, const std::string& path, Material& material) {
  const MapReader keys(tree, path, {"rate", "center"});
  material.turntable_rate =
      read_number(keys.require("rate", rate_range.describe()), keys.path_of("rate"), rate_range);
  material.turntable_center = read_vector2(keys.require("center", "[x, y] [m], the centre of rotation"),
                                           keys.path_of("center"), coordinate_range);
}

void read_ground_motion(const MapReader& keys, Material& material) {
  if (material.law == Law::smooth) {
    constexpr const char* why = "smooth ground drags nothing along, moving or not";
    keys.refuse("belt", why);
    keys.refuse("turntable", why);
    return;
  }
  const Tree* belt = keys.find("belt");
  const Tree* turntable = keys.find("turntable");
  if (belt && turntable) {
    throw SceneError(keys.path_of("turntable"), turntable->describe() + " together with belt",
                     "at most one of belt and turntable");
  }
  if (belt) material.belt = read_vector2(*belt, keys.path_of("belt"), belt_range);
  if (turntable) read_turntable(*turntable, keys.path_of("turntable"), material);
}

}  // namespace

const Keys& material_keys() {
  static const Keys keys{"law", "friction", "rolling_resistance", "spin_friction", "belt", "turntable"};
  return keys;
}

Material read_material(const MapReader& keys, std::optional<Law> default_law) {
  Material material(read_law(keys, default_law));
  read_coefficients(keys, material);
  read_ground_motion(keys, material);
  return material;
}

}  // namespace hybrid_sphere::scene
