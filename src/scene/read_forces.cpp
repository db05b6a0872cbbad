#include "scene/map_reader.hpp"
#include "scene/read_tree.hpp"

namespace hybrid_sphere::scene {
namespace {

Vector3d read_gravity(const Tree& tree, const std::string& path) {
  const std::vector<double> xyz = read_numbers(tree, path, 3, in_plane_range);
  read_number((*tree.as_list())[2], path + "[2]", normal_range);
  return Vector3d(xyz.data());
}

Drag read_drag(const Tree& tree, const SphereBody& sphere, const std::string& path) {
  const MapReader keys(tree, path, {"translational", "rotational", "quadratic"});
  const auto read = [&](const char* key, const Range& range) {
    const Tree* value = keys.find(key);
    return value ? read_number(*value, keys.path_of(key), range) : 0;
  };
  Drag drag;
  drag.translational = read("translational", translational_drag_range(sphere));
  drag.rotational = read("rotational", rotational_drag_range(sphere));
  drag.quadratic = read("quadratic", quadratic_drag_range(sphere));
  return drag;
}

Spring read_spring(const Tree& tree, const SphereBody& sphere, const std::string& path) {
  const MapReader keys(tree, path, {"center", "stiffness"});
  Spring spring;
  if (const Tree* center = keys.find("center")) {
    spring.center = read_vector2(*center, keys.path_of("center"), coordinate_range);
  }
  const Range range = stiffness_range(sphere);
  spring.stiffness =
      read_number(keys.require("stiffness", range.describe()), keys.path_of("stiffness"), range);
  return spring;
}

}  // namespace

Wrench read_wrench(const Tree& tree, const SphereBody& sphere, const std::string& path) {
  const MapReader keys(tree, path, {"force", "torque"});
  Wrench wrench;
  if (const Tree* force = keys.find("force")) {
    wrench.force = read_vector2(*force, keys.path_of("force"), force_range(sphere));
  }
  if (const Tree* torque = keys.find("torque")) {
    wrench.torque = Vector3d(read_numbers(*torque, keys.path_of("torque"), 3, torque_range(sphere)).data());
  }
  return wrench;
}

Forces read_forces(const MapReader& keys, const SphereBody& sphere) {
  Forces forces;
  if (const Tree* gravity = keys.find("gravity")) {
    forces.gravity = read_gravity(*gravity, keys.path_of("gravity"));
  }
  if (const Tree* wrench = keys.find("wrench")) {
    forces.wrench = read_wrench(*wrench, sphere, keys.path_of("wrench"));
  }
  if (const Tree* drag = keys.find("drag")) forces.drag = read_drag(*drag, sphere, keys.path_of("drag"));
  if (const Tree* spring = keys.find("spring")) {
    forces.spring = read_spring(*spring, sphere, keys.path_of("spring"));
  }
  return forces;
}

}  // namespace hybrid_sphere::scene
