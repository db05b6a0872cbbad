#pragma once

#include "scene/tree.hpp"
#include "simulation/motion_kind.hpp"

namespace hybrid_sphere {

/// Describes why a motion has no closed form.
inline const char* to_string(Obstacle obstacle) {
  switch (obstacle) {
    case Obstacle::quadratic_drag: return "quadratic drag";
    case Obstacle::turntable: return "dry friction on a turntable";
    case Obstacle::drag: return "dry friction with drag";
    case Obstacle::spring: return "dry friction with a spring";
    case Obstacle::friction_limit: return "rolling resistance under a force on coulomb ground";
    case Obstacle::turning: return "sliding against rolling resistance";
    case Obstacle::torque: return "a torque on a sphere sliding against rolling resistance";
    case Obstacle::none: break;
  }
  return "";
}

/// Throws scene::SceneError if the method exact is requested and some ground of the surface needs numerical
/// integration for any motion possible on it, whether or not the sphere ever gets there.
inline void check_method(const scene::Solver& solver, const Dynamics& dynamics,
                         const scene::Surface& surface) {
  if (solver.method != scene::Solver::Method::exact) return;
  const auto check = [&](const scene::Material& material, const std::string& name) {
    for (const ContactMode mode : contact_modes_on(dynamics, material)) {
      const Obstacle obstacle = obstacle_to_closed_form(dynamics, mode, material);
      if (obstacle == Obstacle::none) continue;
      throw scene::SceneError(
          "solver.method", "exact",
          std::string("auto, as ") + to_string(obstacle) + " (ground \"" + name + "\") has no closed form");
    }
  };
  check(surface.base, scene::base_name);
  for (const scene::Region& region : surface.regions) check(region.material, region.name);
}

/// The same for the surface of a scene.
inline void check_method(const scene::Scene& scene) {
  check_method(scene.solver, Dynamics(Sphere(scene.sphere), scene.forces), scene.surface);
}

}  // namespace hybrid_sphere
