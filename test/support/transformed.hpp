#pragma once

#include "hybrid_sphere/scene/scene.hpp"

namespace hybrid_sphere::testing {

/// Old units measured in new ones.
struct Units {
  double length;
  double time;
  double mass;
};

scene::Scene in_units(scene::Scene scene, const Units& units);

/// The same scene elsewhere.
scene::Scene shifted(scene::Scene scene, const Vector2d& way);

/// A symmetry of the plane that takes the axes to the axes, so that it rounds nothing.
class Symmetry {
 public:
  /// @param rows  of an orthogonal matrix of -1, 0 and 1
  explicit Symmetry(const Eigen::Matrix2d& rows, const Quaterniond& turn) : matrix_(rows), turn_(turn) {}

  Vector2d of(const Vector2d& v) const { return matrix_ * v; }
  /// Angular velocities are pseudovectors.
  Vector3d of_spin(const Vector3d& omega) const;
  Quaterniond of(const Quaterniond& q) const;
  scene::Shape of(const scene::Shape& shape) const;
  scene::Material of(scene::Material material) const;
  scene::Forces of(scene::Forces forces) const;
  scene::Scene of(scene::Scene scene) const;

 private:
  bool mirrors() const { return matrix_.determinant() < 0; }

  Eigen::Matrix2d matrix_;
  Quaterniond turn_;
};

/// y to -y.
Symmetry mirror();

/// By +90 degrees about z.
Symmetry quarter_turn();

}  // namespace hybrid_sphere::testing
