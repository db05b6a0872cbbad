#include "hybrid_sphere/scene/validate.hpp"

#include "scene/check.hpp"

namespace hybrid_sphere::scene {

void validate(const Scene& scene) {
  check_sphere(scene.sphere, "sphere");
  check_initial_state(scene.initial_state, "initial_state");
  check_surface(scene.surface, "surface");
  check_forces(scene.forces, scene.sphere, "");
  check_pressure(scene.surface, scene.forces, "surface");
  check_solver(scene.solver, "solver");
}

}  // namespace hybrid_sphere::scene
