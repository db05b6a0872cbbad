#include "scene/read_tree.hpp"

#include <cmath>
#include <filesystem>

#include "hybrid_sphere/scene/read_scene.hpp"
#include "scene/check.hpp"
#include "scene/map_reader.hpp"
#include "scene/yaml.hpp"

namespace hybrid_sphere::scene {
namespace {

double read_gyration_radius(const MapReader& keys, double radius) {
  const Tree* body = keys.find("body");
  const Tree* gyration_radius = keys.find("gyration_radius");
  constexpr const char* allowed = "exactly one of body (solid, shell) and gyration_radius";
  if (!body && !gyration_radius) throw SceneError::missing(keys.path_of("body"), allowed);
  if (body && gyration_radius) {
    throw SceneError(keys.path_of("body"), body->describe() + " together with gyration_radius", allowed);
  }
  if (body) {
    const bool is_solid = read_word(*body, keys.path_of("body"), {"solid", "shell"}) == "solid";
    return radius * std::sqrt(is_solid ? 2. / 5 : 2. / 3);
  }
  return read_number(*gyration_radius, keys.path_of("gyration_radius"), gyration_range(radius));
}

Quaterniond read_orientation(const Tree& tree, const std::string& path) {
  const std::vector<double> q = read_numbers(tree, path, 4, quaternion_range);
  const Quaterniond orientation(q[3], q[0], q[1], q[2]);
  check_unit(orientation, path);
  return orientation.normalized();
}

Solver::Method read_method(const Tree& tree, const std::string& path) {
  std::vector<const char*> words;
  for (const MethodName& named : method_names) words.push_back(named.name);
  const std::string word = read_word(tree, path, words);
  for (const MethodName& named : method_names) {
    if (word == named.name) return named.method;
  }
  return Solver::Method::automatic;
}

}  // namespace

SphereBody read_sphere(const Tree& tree, const std::string& path) {
  const MapReader keys(tree, path, {"mass", "radius", "body", "gyration_radius"});
  SphereBody sphere{};
  sphere.mass = read_number(keys.require("mass", mass_range.describe()), keys.path_of("mass"), mass_range);
  sphere.radius =
      read_number(keys.require("radius", radius_range.describe()), keys.path_of("radius"), radius_range);
  sphere.gyration_radius = read_gyration_radius(keys, sphere.radius);
  return sphere;
}

InitialState read_initial_state(const Tree& tree, const std::string& path) {
  const MapReader keys(tree, path, {"position", "orientation", "velocity", "angular_velocity"});
  InitialState state;
  if (const Tree* value = keys.find("position")) {
    state.position = Vector2d(read_numbers(*value, keys.path_of("position"), 2, coordinate_range).data());
  }
  if (const Tree* value = keys.find("orientation")) {
    state.orientation = read_orientation(*value, keys.path_of("orientation"));
  }
  if (const Tree* value = keys.find("velocity")) {
    state.velocity = Vector2d(read_numbers(*value, keys.path_of("velocity"), 2, velocity_range).data());
  }
  if (const Tree* value = keys.find("angular_velocity")) {
    state.angular_velocity =
        Vector3d(read_numbers(*value, keys.path_of("angular_velocity"), 3, spin_range).data());
  }
  return state;
}

Solver read_solver(const Tree& tree, const std::string& path) {
  const MapReader keys(tree, path, {"method", "accuracy", "step"});
  Solver solver;
  if (const Tree* value = keys.find("method")) solver.method = read_method(*value, keys.path_of("method"));
  if (const Tree* value = keys.find("accuracy")) {
    solver.accuracy = read_number(*value, keys.path_of("accuracy"), accuracy_range);
  }
  if (const Tree* value = keys.find("step")) {
    solver.step = read_number(*value, keys.path_of("step"), step_range);
  }
  return solver;
}

const std::vector<const char*>& scene_keys() {
  static const Keys keys{"sphere", "initial_state", "surface", "gravity",
                         "wrench", "drag",          "spring",  "solver"};
  return keys;
}

Scene read_scene(const Tree& tree, const std::string& base_directory,
                 const std::vector<const char*>& beside) {
  const MapReader keys(tree, "", scene_keys(), beside);
  Scene scene{};
  scene.sphere = read_sphere(keys.require("sphere", "a map with mass, radius and body or gyration_radius"));
  if (const Tree* value = keys.find("initial_state")) scene.initial_state = read_initial_state(*value);
  if (const Tree* value = keys.find("surface")) {
    scene.surface = read_surface(*value, "surface", base_directory, &scene.warnings);
  }
  scene.forces = read_forces(keys, scene.sphere);
  check_pressure(scene.surface, scene.forces, "surface");
  if (const Tree* value = keys.find("solver")) scene.solver = read_solver(*value);
  return scene;
}

Scene read_scene_file(const std::string& file) {
  return read_scene(tree_from_yaml_file(file), std::filesystem::path(file).parent_path().string());
}

Scene read_scene_text(std::string_view yaml, const std::string& base_directory) {
  return read_scene(tree_from_yaml(std::string(yaml)), base_directory);
}

}  // namespace hybrid_sphere::scene
