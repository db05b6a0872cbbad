#include "support/random_scenes.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/simple_polygon.hpp"

namespace hybrid_sphere::testing {
namespace {

bool chance(int one_in) { return integer(1, one_in) == 1; }

Vector2d random_vector(int denominator) { return Vector2d(integer(-8, 8), integer(-8, 8)) / denominator; }

// In the order of their angle round one of them, or as they come: star-shaped or arbitrary.
std::vector<Vector2d> random_corners() {
  const int count = integer(3, 8);
  std::vector<Vector2d> corners;
  for (int i = 0; i < count; ++i) corners.push_back(random_grid_point());
  const Vector2d center = random_grid_point() / 2;
  const auto angle = [&](const Vector2d& p) { return std::atan2(p.y() - center.y(), p.x() - center.x()); };
  std::sort(corners.begin(), corners.end(),
            [&](const Vector2d& p, const Vector2d& q) { return angle(p) < angle(q); });
  return corners;
}

scene::Shape random_polygon() {
  for (int attempt = 0; attempt < 20; ++attempt) {
    std::vector<Vector2d> corners = random_corners();
    if (geometry::fault_of_polygon(corners)) continue;
    if (!geometry::is_counter_clockwise(corners)) std::reverse(corners.begin(), corners.end());
    return scene::Polygon{corners, chance(4)};
  }
  const Vector2d corner = random_grid_point();
  return scene::Polygon{{corner, corner + Vector2d(2, 0), corner + Vector2d(2, 3), corner + Vector2d(0, 3)},
                        false};
}

}  // namespace

Vector2d random_direction() {
  const Vector2d direction(integer(-4, 4), integer(-4, 4));
  return direction.isZero(0) ? Vector2d(1, 0) : direction;
}

Vector2d random_grid_point() { return {integer(-8, 8), integer(-8, 8)}; }

scene::Shape random_shape() {
  switch (integer(0, 3)) {
    case 0: return scene::HalfPlane{random_grid_point(), random_direction()};
    case 1: return scene::Circle{random_grid_point(), static_cast<double>(integer(1, 6)), chance(4)};
    default: return random_polygon();
  }
}

scene::Surface random_surface() {
  scene::Surface surface;
  surface.base = chance(3) ? scene::Law::rough : scene::Law::smooth;
  const int count = integer(0, 8);
  for (int i = 0; i < count; ++i) {
    surface.regions.push_back(
        {"region_" + std::to_string(i), random_shape(), chance(2) ? scene::Law::rough : scene::Law::smooth});
  }
  return surface;
}

scene::Scene random_scene() {
  scene::Scene scene{};
  scene.sphere = {integer(1, 8) / 4.0, integer(1, 8) / 8.0, 0};
  scene.sphere.gyration_radius = scene.sphere.radius * integer(1, 12) / 16.0;
  scene.initial_state.position = random_grid_point();
  scene.initial_state.velocity = random_direction();
  scene.initial_state.angular_velocity = Vector3d(integer(-64, 64), integer(-64, 64), integer(-64, 64)) / 8.0;
  scene.initial_state.orientation =
      Quaterniond(integer(1, 8), integer(-8, 8), integer(-8, 8), integer(-8, 8)).normalized();
  scene.surface = random_surface();
  return scene;
}

scene::Material random_material() {
  using scene::Law;
  constexpr Law laws[] = {Law::smooth, Law::smooth,  Law::rough,   Law::rough,
                          Law::rubber, Law::coulomb, Law::coulomb, Law::coulomb};
  scene::Material material = laws[integer(0, 7)];
  if (material.law == Law::smooth) return material;
  if (material.law == Law::coulomb) material.friction = integer(0, 16) / 32.0;
  if (chance(4) && material.law != Law::coulomb) material.rolling_resistance = integer(1, 4) / 64.0;
  if (chance(4) && material.law != Law::rubber) material.spin_friction = integer(1, 4) / 64.0;
  if (chance(3)) material.belt = random_vector(4);
  if (chance(5)) {
    material.turntable_rate = integer(-8, 8) / 4.0;
    material.turntable_center = random_grid_point();
  }
  return material;
}

namespace {

scene::Forces random_forces(const scene::SphereBody& sphere) {
  const double inertia = sphere.mass * sphere.gyration_radius * sphere.gyration_radius;
  scene::Forces forces;
  forces.gravity = {0, 0, -8};
  if (chance(3)) forces.gravity.head<2>() = random_vector(8);
  if (chance(5)) forces.wrench.force = random_vector(16);
  if (chance(5)) forces.wrench.torque = Vector3d(integer(-8, 8), integer(-8, 8), integer(-8, 8)) / 64.0;
  if (chance(6)) forces.drag.translational = integer(1, 8) / 16.0;
  if (chance(6)) forces.drag.rotational = inertia * integer(1, 8) / 16.0;
  if (chance(8)) forces.drag.quadratic = integer(1, 8) / 32.0;
  if (chance(8)) forces.spring = {random_vector(2), integer(1, 8) / 8.0};
  return forces;
}

}  // namespace

scene::Scene random_any_scene() {
  scene::Scene scene = random_scene();
  scene.surface.base = random_material();
  for (scene::Region& region : scene.surface.regions) region.material = random_material();
  if (chance(3)) scene.surface.livelock = scene::Livelock::stop;
  if (!chance(3)) scene.forces = random_forces(scene.sphere);
  if (chance(8)) scene.initial_state.velocity.setZero();
  return scene;
}

scene::Scene off_grid(scene::Scene scene) {
  const auto off = [] { return integer(-1000000, 1000000) * 1e-7; };
  scene.initial_state.position += Vector2d(off(), off());
  scene.initial_state.velocity += Vector2d(off(), off());
  scene.initial_state.angular_velocity += Vector3d(off(), off(), off());
  return scene;
}

}  // namespace hybrid_sphere::testing
