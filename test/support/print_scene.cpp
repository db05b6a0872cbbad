#include "support/print_scene.hpp"

#include <iomanip>
#include <ostream>

namespace hybrid_sphere::testing {
namespace {

const Eigen::IOFormat list(17, Eigen::DontAlignCols, ", ", ", ", "", "", "[", "]");

void print_forces(std::ostream& out, const scene::Forces& forces) {
  out << "gravity: " << forces.gravity.format(list)
      << "\nwrench: {force: " << forces.wrench.force.format(list)
      << ", torque: " << forces.wrench.torque.format(list)
      << "}\ndrag: {translational: " << forces.drag.translational
      << ", rotational: " << forces.drag.rotational << ", quadratic: " << forces.drag.quadratic << "}\n";
  if (forces.spring.stiffness == 0) return;
  out << "spring: {center: " << forces.spring.center.format(list)
      << ", stiffness: " << forces.spring.stiffness << "}\n";
}

}  // namespace

std::ostream& operator<<(std::ostream& out, const scene::Shape& shape) {
  out << std::setprecision(17);
  if (const auto* half_plane = std::get_if<scene::HalfPlane>(&shape)) {
    return out << "half_plane: {point: " << half_plane->point.format(list)
               << ", normal: " << half_plane->normal.format(list) << "}";
  }
  if (const auto* circle = std::get_if<scene::Circle>(&shape)) {
    return out << "circle: {center: " << circle->center.format(list) << ", radius: " << circle->radius << "}"
               << (circle->outside ? ", outside: true" : "");
  }
  const auto& polygon = std::get<scene::Polygon>(shape);
  out << "polygon: [";
  for (const Vector2d& vertex : polygon.vertices)
    out << (&vertex == &polygon.vertices[0] ? "" : ", ") << vertex.format(list);
  return out << "]" << (polygon.outside ? ", outside: true" : "");
}

std::ostream& operator<<(std::ostream& out, const scene::Material& material) {
  out << std::setprecision(17) << "law: " << to_string(material.law);
  if (material.law == scene::Law::coulomb) out << ", friction: " << material.friction;
  if (material.rolling_resistance != 0) out << ", rolling_resistance: " << material.rolling_resistance;
  if (material.spin_friction != 0) out << ", spin_friction: " << material.spin_friction;
  if (!material.belt.isZero(0)) out << ", belt: " << material.belt.format(list);
  if (material.turntable_rate != 0) {
    out << ", turntable: {center: " << material.turntable_center.format(list)
        << ", rate: " << material.turntable_rate << "}";
  }
  return out;
}

std::ostream& operator<<(std::ostream& out, const scene::Scene& scene) {
  const auto& [mass, radius, gyration_radius] = scene.sphere;
  const scene::InitialState& start = scene.initial_state;
  const Quaterniond& q = start.orientation;
  out << std::setprecision(17) << "sphere: {mass: " << mass << ", radius: " << radius
      << ", gyration_radius: " << gyration_radius << "}\n"
      << "initial_state:\n  position: " << start.position.format(list)
      << "\n  orientation: " << Eigen::Vector4d(q.coeffs()).format(list)
      << "\n  velocity: " << start.velocity.format(list)
      << "\n  angular_velocity: " << start.angular_velocity.format(list) << "\n";
  print_forces(out, scene.forces);
  out << "surface:\n  livelock: " << (scene.surface.livelock == scene::Livelock::stop ? "stop" : "slide")
      << "\n  base: {" << scene.surface.base
      << "}\n  regions:" << (scene.surface.regions.empty() ? " []\n" : "\n");
  for (const scene::Region& region : scene.surface.regions)
    out << "    - {name: " << region.name << ", " << region.shape << ", " << region.material << "}\n";
  return out << "solver: {method: " << to_string(scene.solver.method)
             << ", accuracy: " << scene.solver.accuracy << ", step: " << scene.solver.step << "}\n";
}

}  // namespace hybrid_sphere::testing
