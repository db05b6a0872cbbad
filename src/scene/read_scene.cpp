#include "scene/read_tree.hpp"

#include <cmath>
#include <filesystem>

#include "hybrid_sphere/scene/read_scene.hpp"
#include "scene/map_reader.hpp"
#include "scene/yaml.hpp"

namespace hybrid_sphere::scene {
namespace {

// Within these ranges no product of the computation leaves the range of binary64.
constexpr Range mass_range{1e-60, 1e60, "[kg]"};
constexpr Range radius_range{1e-12, 1e12, "[m]"};
constexpr Range position_range{-1e15, 1e15, "[m]"};
constexpr Range velocity_range{-1e15, 1e15, "[m/s]"};
constexpr Range spin_range{-1e15, 1e15, "[rad/s]"};
constexpr Range quaternion_range{-1.01, 1.01, "", 0};
constexpr Range accuracy_range{1e-14, 1, ""};
constexpr Range step_range{1e-9, 1e6, "[s]"};
constexpr double thinnest = 1e-9;    // least k/R
constexpr double unit_slack = 0.01;  // of the length of a quaternion typed by hand

double read_gyration_radius(const MapReader& keys, double radius) {
  const Tree* body = keys.find("body");
  const Tree* gyration_radius = keys.find("gyration_radius");
  constexpr const char* allowed = "exactly one of body (solid, shell) and gyration_radius";
  if (!body && !gyration_radius) throw SceneError::missing(keys.path_of("body"), allowed);
  if (body && gyration_radius) {
    throw SceneError(keys.path_of("body"), body->describe() + " beside gyration_radius", allowed);
  }
  if (body)
    return radius *
           std::sqrt(
               (read_word(*body, keys.path_of("body"), {"solid", "shell"}) == "solid" ? 2. / 5 : 2. / 3));
  // A shell's own k, rounded on the way, is still a shell's.
  const double most = radius * std::sqrt(2. / 3) * (1 + 1e-15);
  return read_number(*gyration_radius, keys.path_of("gyration_radius"),
                     {thinnest * radius, most, "[m] (R sqrt(2/3))"});
}

Quaterniond read_orientation(const Tree& tree, const std::string& path) {
  const std::vector<double> q = read_numbers(tree, path, 4, quaternion_range);
  const Quaterniond orientation(q[3], q[0], q[1], q[2]);
  if (std::abs(orientation.norm() - 1) > unit_slack) {
    throw SceneError(path, tree.describe(),
                     "a unit quaternion x, y, z, w (its length is made 1 from within 1 %)");
  }
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
    state.position = Vector2d(read_numbers(*value, keys.path_of("position"), 2, position_range).data());
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

Scene read_scene(const Tree& tree, const std::string& base_directory,
                 const std::vector<const char*>& beside) {
  static const Keys known{"sphere", "initial_state", "surface", "gravity",
                          "wrench", "drag",          "spring",  "solver"};
  const MapReader keys(tree, "", known, beside);
  Scene scene{};
  scene.sphere = read_sphere(keys.require("sphere", "a map with mass, radius and body or gyration_radius"));
  if (const Tree* value = keys.find("initial_state")) scene.initial_state = read_initial_state(*value);
  if (const Tree* value = keys.find("surface")) {
    scene.surface = read_surface(*value, "surface", base_directory);
  }
  scene.forces = read_forces(keys, scene.sphere);
  check_surface(scene.surface, scene.forces);
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
