#pragma once

#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "core/mechanics/sphere_models.hpp"

namespace hybrid_sphere::testing {

/// A scene, its rough grounds as guards, how long it runs, and how many switches that are.
struct Ride {
  std::string name;
  scene::Scene scene;
  std::vector<RoughGround> grounds;
  double duration = 4;  ///< [s]
  std::size_t switches = 1;
};

inline std::ostream& operator<<(std::ostream& stream, const Ride& ride) { return stream << ride.name; }

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

inline Ride paper() {
  return {"paper", scene_of({half_plane("rough", 0, scene::Law::rough)}), {{"rough", {0}}}};
}

/// Backspin sends the sphere back from the edge.
inline Ride throw_back() {
  Ride ride = paper();
  ride.name = "throw_back";
  ride.scene.initial_state.angular_velocity.y() = -12;
  ride.switches = 2;
  return ride;
}

inline Ride start_on_the_edge() {
  Ride ride = paper();
  ride.name = "start_on_the_edge";
  ride.scene.initial_state.position.x() = 0;
  return ride;
}

/// Three rough strips, one of them thin.
inline Ride strips() {
  const std::vector<double> edges = {-1, -0.5, 0, 0.3, 0.31, 1};
  Ride ride = {"strips", scene_of({}), {{"rough", edges}}};
  for (std::size_t i = 0; i < edges.size(); i += 2) {
    ride.scene.surface.regions.push_back(
        {"rough",
         scene::Polygon{{{edges[i], -90}, {edges[i + 1], -90}, {edges[i + 1], 90}, {edges[i], 90}}, false},
         scene::Law::rough});
  }
  ride.switches = 6;
  return ride;
}

/// On a slope: slip comes back on each smooth strip.
inline Ride strips_on_a_slope() {
  Ride ride = strips();
  ride.name = "strips_on_a_slope";
  ride.scene.forces.gravity = {0.75, 0.5, -9.81};
  ride.duration = 3;
  return ride;
}

/// Rough and smooth strips of half a period each, on a slope.
inline Ride sine_strips(double period) {
  Ride ride = {"sine_strips", scene_of({}), {{"rough", {}, period}}};
  ride.scene.forces.gravity = {0.125, 0.25, -9.81};
  ride.scene.initial_state.position.x() = -0.25 * period;
  for (int i = 0; i < 100; ++i) {
    const double left = i * period, right = left + period / 2;
    ride.scene.surface.regions.push_back(
        {"rough", scene::Polygon{{{left, -90}, {right, -90}, {right, 90}, {left, 90}}, false},
         scene::Law::rough});
  }
  ride.switches = 11;
  return ride;
}

/// Onto a turning disc and off it.
inline Ride turntable() {
  Ride ride = {"turntable",
               scene_of({{"disc", scene::Circle{{0.25, 0}, 1.5, false}, table(3, {0.25, 0})}}),
               {{"disc", {}, 0, {0.25, 0}, 1.5}}};
  ride.scene.initial_state.position = {-2.5, -0.25};
  ride.scene.initial_state.velocity = {1.5, 0.25};
  ride.duration = 6;
  ride.switches = 2;
  return ride;
}

inline Ride tilted_turntable() {
  Ride ride = turntable();
  ride.name = "tilted_turntable";
  ride.scene.forces.gravity = {0, -0.25, -9.81};
  ride.duration = 3;
  return ride;
}

inline Ride incline() {
  Ride ride = paper();
  ride.name = "incline";
  ride.scene.forces.gravity = {0.5, -0.25, -9.81};
  return ride;
}

/// From belt to belt: one constraint for another, in one switch.
inline Ride belts() {
  Ride ride = {"belts",
               scene_of({half_plane("north", -1, belt(0.25, 0.75)), half_plane("south", 0, belt(0.25, -0.75)),
                         half_plane("floor", 1, scene::Law::smooth)}),
               {{"north", {-1, 0}}, {"south", {0, 1}}}};
  ride.switches = 3;
  return ride;
}

/// All of them.
inline std::vector<Ride> rides() {
  return {paper(),           throw_back(), start_on_the_edge(), strips(),  strips_on_a_slope(),
          sine_strips(0.75), turntable(),  tilted_turntable(),  incline(), belts()};
}

}  // namespace hybrid_sphere::testing
