#pragma once

#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "core/mechanics/sphere_models.hpp"

namespace hybrid_sphere::testing {

/// A scene, its rough grounds as guards, how long it runs, and how many switches that are.
struct SphereCase {
  std::string name;
  scene::Scene scene;
  std::vector<RoughGround> grounds;
  double duration = 4;  ///< [s]
  std::size_t switches = 1;
};

inline std::ostream& operator<<(std::ostream& stream, const SphereCase& example) {
  return stream << example.name;
}

inline scene::Scene scene_of(const std::vector<scene::Region>& regions) {
  scene::Scene scene{};
  scene.sphere = {2, 0.25, 0.25 * std::sqrt(0.4)};
  scene.initial_state.position = {-2, 0.5};
  scene.initial_state.velocity = {1, -0.375};
  scene.initial_state.angular_velocity = {4, 1.5, -2};
  // Axis of the body along x: sin(theta) stays above 0.5.
  scene.initial_state.orientation = Quaterniond(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ()) *
                                                Eigen::AngleAxisd(1.25, Vector3d::UnitX()));
  scene.surface.regions = regions;
  return scene;
}

inline scene::Region half_plane(const std::string& name, double edge, const scene::Material& material) {
  return {name, scene::HalfPlane{{edge, 0}, {1, 0}}, material};
}

inline scene::Material belt(double x, double y) {
  scene::Material material(scene::Law::rough);
  material.belt = {x, y};
  return material;
}

inline scene::Material table(double rate, const Vector2d& center) {
  scene::Material material(scene::Law::rough);
  material.turntable_rate = rate;
  material.turntable_center = center;
  return material;
}

inline SphereCase paper() {
  return {"paper", scene_of({half_plane("rough", 0, scene::Law::rough)}), {{"rough", {0}}}};
}

/// Backspin sends the sphere back from the edge.
inline SphereCase throw_back() {
  SphereCase example = paper();
  example.name = "throw_back";
  example.scene.initial_state.angular_velocity.y() = -12;
  example.switches = 2;
  return example;
}

inline SphereCase start_on_the_edge() {
  SphereCase example = paper();
  example.name = "start_on_the_edge";
  example.scene.initial_state.position.x() = 0;
  return example;
}

/// Three rough strips, one of them thin.
inline SphereCase strips() {
  const std::vector<double> edges = {-1, -0.5, 0, 0.3, 0.31, 1};
  SphereCase example = {"strips", scene_of({}), {{"rough", edges}}};
  for (std::size_t i = 0; i < edges.size(); i += 2) {
    example.scene.surface.regions.push_back(
        {"rough",
         scene::Polygon{{{edges[i], -90}, {edges[i + 1], -90}, {edges[i + 1], 90}, {edges[i], 90}}, false},
         scene::Law::rough});
  }
  example.switches = 6;
  return example;
}

/// On a slope: slip comes back on each smooth strip.
inline SphereCase strips_on_a_slope() {
  SphereCase example = strips();
  example.name = "strips_on_a_slope";
  example.scene.forces.gravity = {0.75, 0.5, -9.81};
  example.duration = 3;
  return example;
}

/// Rough and smooth strips of half a period each, on a slope.
inline SphereCase sine_strips(double period) {
  SphereCase example = {"sine_strips", scene_of({}), {{"rough", {}, period}}};
  example.scene.forces.gravity = {0.125, 0.25, -9.81};
  example.scene.initial_state.position.x() = -0.25 * period;
  for (int i = 0; i < 100; ++i) {
    const double left = i * period, right = left + period / 2;
    example.scene.surface.regions.push_back(
        {"rough", scene::Polygon{{{left, -90}, {right, -90}, {right, 90}, {left, 90}}, false},
         scene::Law::rough});
  }
  example.switches = 11;
  return example;
}

/// Onto a turning disc and off it.
inline SphereCase turntable() {
  SphereCase example = {"turntable",
                        scene_of({{"disc", scene::Circle{{0.25, 0}, 1.5, false}, table(3, {0.25, 0})}}),
                        {{"disc", {}, 0, {0.25, 0}, 1.5}}};
  example.scene.initial_state.position = {-2.5, -0.25};
  example.scene.initial_state.velocity = {1.5, 0.25};
  example.duration = 6;
  example.switches = 2;
  return example;
}

inline SphereCase tilted_turntable() {
  SphereCase example = turntable();
  example.name = "tilted_turntable";
  example.scene.forces.gravity = {0, -0.25, -9.81};
  example.duration = 3;
  return example;
}

inline SphereCase incline() {
  SphereCase example = paper();
  example.name = "incline";
  example.scene.forces.gravity = {0.5, -0.25, -9.81};
  return example;
}

/// From belt to belt: one constraint for another, in one switch.
inline SphereCase belts() {
  SphereCase example = {
      "belts",
      scene_of({half_plane("north", -1, belt(0.25, 0.75)), half_plane("south", 0, belt(0.25, -0.75)),
                half_plane("floor", 1, scene::Law::smooth)}),
      {{"north", {-1, 0}}, {"south", {0, 1}}}};
  example.switches = 3;
  return example;
}

/// All of them.
inline std::vector<SphereCase> sphere_cases() {
  return {paper(),           throw_back(), start_on_the_edge(), strips(),  strips_on_a_slope(),
          sine_strips(0.75), turntable(),  tilted_turntable(),  incline(), belts()};
}

}  // namespace hybrid_sphere::testing
