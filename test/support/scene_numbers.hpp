#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <variant>
#include <vector>

#include "hybrid_sphere/scene/scene.hpp"

namespace hybrid_sphere::testing {

/// Everything in a scene, its numbers to the bit.
class SceneNumbers {
 public:
  explicit SceneNumbers(const scene::Scene& scene) {
    add({scene.sphere.mass, scene.sphere.radius, scene.sphere.gyration_radius});
    const scene::InitialState& start = scene.initial_state;
    add_vector(start.position);
    add_vector(start.orientation.coeffs());
    add_vector(start.velocity);
    add_vector(start.angular_velocity);
    add_material(scene.surface.base);
    for (const scene::Region& region : scene.surface.regions) add_region(region);
    add({static_cast<double>(scene.surface.livelock), static_cast<double>(scene.surface.image_regions)});
    add_forces(scene.forces);
    add({static_cast<double>(scene.solver.method), scene.solver.accuracy, scene.solver.step});
  }

  const std::vector<std::uint64_t>& bits() const { return bits_; }

 private:
  void add(const std::vector<double>& numbers) {
    for (const double number : numbers) {
      bits_.emplace_back();
      std::memcpy(&bits_.back(), &number, sizeof number);
    }
  }
  template <class Vector>
  void add_vector(const Vector& vector) {
    add(std::vector<double>(vector.data(), vector.data() + vector.size()));
  }
  void add_material(const scene::Material& material) {
    add({static_cast<double>(material.law), material.friction, material.rolling_resistance,
         material.spin_friction, material.turntable_rate});
    add_vector(material.belt);
    add_vector(material.turntable_center);
  }
  void add_region(const scene::Region& region) {
    for (const char c : region.name) add({static_cast<double>(c)});
    add_material(region.material);
    add({static_cast<double>(region.shape.index())});
    if (const auto* half_plane = std::get_if<scene::HalfPlane>(&region.shape)) {
      add_vector(half_plane->point);
      add_vector(half_plane->normal);
    } else if (const auto* circle = std::get_if<scene::Circle>(&region.shape)) {
      add_vector(circle->center);
      add({circle->radius, circle->outside ? 1.0 : 0.0});
    } else {
      const auto& polygon = std::get<scene::Polygon>(region.shape);
      for (const Vector2d& vertex : polygon.vertices) add_vector(vertex);
      add({polygon.outside ? 1.0 : 0.0});
    }
  }
  void add_forces(const scene::Forces& forces) {
    add_vector(forces.gravity);
    add_vector(forces.wrench.force);
    add_vector(forces.wrench.torque);
    add({forces.drag.translational, forces.drag.rotational, forces.drag.quadratic});
    add_vector(forces.spring.center);
    add({forces.spring.stiffness});
  }

  std::vector<std::uint64_t> bits_;
};

inline std::vector<std::uint64_t> numbers_of(const scene::Scene& scene) { return SceneNumbers(scene).bits(); }

}  // namespace hybrid_sphere::testing
