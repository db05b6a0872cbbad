#include <algorithm>

#include "scene/map_reader.hpp"
#include "scene/read_tree.hpp"

namespace hybrid_sphere::scene {
namespace {

// With the sphere's ranges no product of the computation leaves the range of binary64.
constexpr double most = 1e15;
// A faster drag than that leaves velocities below the rounding of others, which it makes a force of.
constexpr double fastest_drag = 1e12;
constexpr Range in_plane_range{-most, most, "[m/s^2]"};
constexpr Range normal_range{-most, 0, "[m/s^2], as gravity must not pull the sphere off the ground"};

/// Of forces, which may be so small relative to a sphere that is light, too.
double least_for(double inertia) { return least_size * std::min(1.0, inertia); }

/// m k^2.
double inertia(const SphereBody& sphere) {
  return sphere.mass * sphere.gyration_radius * sphere.gyration_radius;
}

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
  const double least = least_for(sphere.mass);
  drag.translational = read("translational", {0, fastest_drag * sphere.mass, "[N s/m] (1e12 m)", least});
  drag.rotational = read(
      "rotational", {0, fastest_drag * inertia(sphere), "[N m s] (1e12 m k^2)", least_for(inertia(sphere))});
  drag.quadratic = read("quadratic", {0, most * sphere.mass, "[N s^2/m^2] (1e15 m)", least});
  return drag;
}

Spring read_spring(const Tree& tree, const SphereBody& sphere, const std::string& path) {
  const MapReader keys(tree, path, {"center", "stiffness"});
  Spring spring;
  if (const Tree* center = keys.find("center")) {
    spring.center = read_vector2(*center, keys.path_of("center"), coordinate_range);
  }
  const Range stiffness_range{0, most * sphere.mass, "[N/m] (1e15 m)", least_for(sphere.mass)};
  spring.stiffness = read_number(keys.require("stiffness", stiffness_range.describe()),
                                 keys.path_of("stiffness"), stiffness_range);
  return spring;
}

}  // namespace

Wrench read_wrench(const Tree& tree, const SphereBody& sphere, const std::string& path) {
  const MapReader keys(tree, path, {"force", "torque"});
  Wrench wrench;
  if (const Tree* force = keys.find("force")) {
    const double bound = most * sphere.mass;
    wrench.force =
        read_vector2(*force, keys.path_of("force"), {-bound, bound, "[N] (1e15 m)", least_for(sphere.mass)});
  }
  if (const Tree* torque = keys.find("torque")) {
    const double bound = most * inertia(sphere);
    wrench.torque = Vector3d(read_numbers(*torque, keys.path_of("torque"), 3,
                                          {-bound, bound, "[N m] (1e15 m k^2)", least_for(inertia(sphere))})
                                 .data());
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
