#include "support/transformed.hpp"

#include <algorithm>

namespace hybrid_sphere::testing {

namespace {

void change_units(scene::Material& material, const Units& units) {
  material.belt *= units.length / units.time;
  material.turntable_rate /= units.time;
  material.turntable_center *= units.length;
}

void change_units(scene::Forces& forces, const Units& units) {
  const double acceleration = units.length / units.time / units.time;
  forces.gravity *= acceleration;
  forces.wrench.force *= units.mass * acceleration;
  forces.wrench.torque *= units.mass * acceleration * units.length;
  forces.drag.translational *= units.mass / units.time;
  forces.drag.rotational *= units.mass / units.time * units.length * units.length;
  forces.drag.quadratic *= units.mass / units.length;
  forces.spring.center *= units.length;
  forces.spring.stiffness *= units.mass / units.time / units.time;
}

}  // namespace

scene::Scene in_units(scene::Scene scene, const Units& units) {
  const double speed = units.length / units.time;
  change_units(scene.forces, units);
  change_units(scene.surface.base, units);
  scene.sphere.mass *= units.mass;
  scene.sphere.radius *= units.length;
  scene.sphere.gyration_radius *= units.length;
  scene.initial_state.position *= units.length;
  scene.initial_state.velocity *= speed;
  scene.initial_state.angular_velocity /= units.time;
  for (scene::Region& region : scene.surface.regions) {
    change_units(region.material, units);
    if (auto* half_plane = std::get_if<scene::HalfPlane>(&region.shape)) {
      half_plane->point *= units.length;
    } else if (auto* circle = std::get_if<scene::Circle>(&region.shape)) {
      circle->center *= units.length;
      circle->radius *= units.length;
    } else {
      for (Vector2d& vertex : std::get<scene::Polygon>(region.shape).vertices) vertex *= units.length;
    }
  }
  return scene;
}

scene::Scene shifted(scene::Scene scene, const Vector2d& way) {
  scene.initial_state.position += way;
  scene.forces.spring.center += way;
  scene.surface.base.turntable_center += way;
  for (scene::Region& region : scene.surface.regions) {
    region.material.turntable_center += way;
    if (auto* half_plane = std::get_if<scene::HalfPlane>(&region.shape)) {
      half_plane->point += way;
    } else if (auto* circle = std::get_if<scene::Circle>(&region.shape)) {
      circle->center += way;
    } else {
      for (Vector2d& vertex : std::get<scene::Polygon>(region.shape).vertices) vertex += way;
    }
  }
  return scene;
}

Vector3d Symmetry::of_spin(const Vector3d& omega) const {
  const Vector2d turned = matrix_ * omega.head<2>();
  const double sign = mirrors() ? -1 : 1;
  return {sign * turned.x(), sign * turned.y(), sign * omega.z()};
}

Quaterniond Symmetry::of(const Quaterniond& q) const {
  // A mirror conjugates the attitude (y to -y before and after it); a turn acts on the world only.
  return mirrors() ? Quaterniond(q.w(), -q.x(), q.y(), -q.z()) : turn_ * q;
}

scene::Shape Symmetry::of(const scene::Shape& shape) const {
  if (const auto* half_plane = std::get_if<scene::HalfPlane>(&shape)) {
    return scene::HalfPlane{of(half_plane->point), of(half_plane->normal)};
  }
  if (const auto* circle = std::get_if<scene::Circle>(&shape)) {
    return scene::Circle{of(circle->center), circle->radius, circle->outside};
  }
  scene::Polygon polygon = std::get<scene::Polygon>(shape);
  for (Vector2d& vertex : polygon.vertices) vertex = of(vertex);
  if (mirrors()) std::reverse(polygon.vertices.begin(), polygon.vertices.end());
  return polygon;
}

scene::Material Symmetry::of(scene::Material material) const {
  material.belt = of(material.belt);
  if (mirrors()) material.turntable_rate = -material.turntable_rate;
  material.turntable_center = of(material.turntable_center);
  return material;
}

scene::Forces Symmetry::of(scene::Forces forces) const {
  forces.gravity.head<2>() = of(Vector2d(forces.gravity.head<2>()));
  forces.wrench = {of(forces.wrench.force), of_spin(forces.wrench.torque)};
  forces.spring.center = of(forces.spring.center);
  return forces;
}

scene::Scene Symmetry::of(scene::Scene scene) const {
  scene.initial_state.position = of(scene.initial_state.position);
  scene.initial_state.velocity = of(scene.initial_state.velocity);
  scene.initial_state.angular_velocity = of_spin(scene.initial_state.angular_velocity);
  scene.initial_state.orientation = of(scene.initial_state.orientation);
  scene.forces = of(scene.forces);
  scene.surface.base = of(scene.surface.base);
  for (scene::Region& region : scene.surface.regions) {
    region.shape = of(region.shape);
    region.material = of(region.material);
  }
  return scene;
}

Symmetry mirror() { return Symmetry(Vector2d(1, -1).asDiagonal(), Quaterniond::Identity()); }

Symmetry quarter_turn() {
  Eigen::Matrix2d rows;
  rows << 0, -1, 1, 0;
  return Symmetry(rows, Quaterniond(std::sqrt(0.5), 0, 0, std::sqrt(0.5)));
}

}  // namespace hybrid_sphere::testing
