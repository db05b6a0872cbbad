#pragma once

#include <functional>
#include <string>
#include <vector>

#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/scene/scene.hpp"

/// The sphere of a scene as systems of the general engine.
namespace hybrid_sphere::testing {

/// A rough region of a scene with the guard that is positive in it.
struct RoughGround {
  std::string region;  ///< of the scene
  /// g(x, y) of a polynomial in x or of a disc, or a sine: which is told by its fields.
  std::vector<double>
      edges;          ///< g = -+ product of (x - edge): rough right of the first, smooth right of the next
  double period = 0;  ///< > 0: g = sin(2 pi x/period)
  Vector2d center = Vector2d::Zero();
  double radius = 0;  ///< > 0: g = radius^2 - abs(r - center)^2
};

/// Coordinates x, y, psi, theta, phi: (12), (13), (21) of the paper.
mechanics::Model sphere_in_angles(const scene::Scene& scene, const std::vector<RoughGround>& grounds);

/// Coordinates x, y and a quaternion, quasi-velocities x', y', omega: (14).
mechanics::Model sphere_in_quasi_velocities(const scene::Scene& scene,
                                            const std::vector<RoughGround>& grounds);

/// The scene's initial state. Orientation: z-x-z angles, 0 < theta < pi.
mechanics::Initial initial_in_angles(const scene::Scene& scene);
mechanics::Initial initial_in_quasi_velocities(const scene::Scene& scene);

/// The sphere in a state of either system.
struct SphereState {
  Vector2d position;
  Vector2d velocity;
  Vector3d spin;
  Quaterniond orientation;
};
SphereState sphere_of_angles(const mechanics::Vector& q, const mechanics::Vector& v);
SphereState sphere_of_quasi_velocities(const mechanics::Vector& q, const mechanics::Vector& v);

}  // namespace hybrid_sphere::testing
