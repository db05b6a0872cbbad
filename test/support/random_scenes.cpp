#include "support/random_scenes.hpp"

#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "hybrid_sphere/geometry/simple_polygon.hpp"

namespace hybrid_sphere::testing {
// At full size from the first case on.
int integer(int low, int high) { return *rc::gen::resize(100, rc::gen::inRange(low, high + 1)); }

namespace {

bool chance(int one_in) { return integer(1, one_in) == 1; }

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

std::ostream& operator<<(std::ostream& out, const scene::Shape& shape) {
  const auto bracketed = [](const Vector2d& v) {
    std::ostringstream text;
    text << std::setprecision(17) << "[" << v.x() << ", " << v.y() << "]";
    return text.str();
  };
  if (const auto* half_plane = std::get_if<scene::HalfPlane>(&shape)) {
    return out << "half_plane: {point: " << bracketed(half_plane->point)
               << ", normal: " << bracketed(half_plane->normal) << "}";
  }
  if (const auto* circle = std::get_if<scene::Circle>(&shape)) {
    return out << "circle: {center: " << bracketed(circle->center) << ", radius: " << circle->radius << "}"
               << (circle->outside ? ", outside: true" : "");
  }
  const auto& polygon = std::get<scene::Polygon>(shape);
  out << "polygon: [";
  for (const Vector2d& vertex : polygon.vertices)
    out << (&vertex == &polygon.vertices[0] ? "" : ", ") << bracketed(vertex);
  return out << "]" << (polygon.outside ? ", outside: true" : "");
}

std::ostream& operator<<(std::ostream& out, const scene::Scene& scene) {
  const Eigen::IOFormat list(17, Eigen::DontAlignCols, ", ", ", ", "", "", "[", "]");
  const auto& [mass, radius, gyration_radius] = scene.sphere;
  const scene::InitialState& start = scene.initial_state;
  out << std::setprecision(17) << "sphere: {mass: " << mass << ", radius: " << radius
      << ", gyration_radius: " << gyration_radius << "}\n"
      << "initial_state:\n  position: " << start.position.format(list)
      << "\n  orientation: " << start.orientation.coeffs().format(list)
      << "\n  velocity: " << start.velocity.format(list)
      << "\n  angular_velocity: " << start.angular_velocity.format(list)
      << "\nsurface:\n  base: {law: " << to_string(scene.surface.base) << "}\n  regions:\n";
  for (const scene::Region& region : scene.surface.regions) {
    out << "    - {name: " << region.name << ", " << region.shape << ", law: " << to_string(region.law)
        << "}\n";
  }
  return out;
}

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

}  // namespace hybrid_sphere::testing
