#pragma once

#include <utility>
#include <vector>

#include "mechanics/body_constraint.hpp"

namespace hybrid_sphere::mechanics {

/// What a joint holds together, on the axes of its two bodies.
struct JointGeometry {
  /// The point of either body [m].
  Eigen::Vector3d first_point;
  Eigen::Vector3d second_point;
  /// Whether the points coincide: three functions, their difference in the world.
  bool has_point = false;
  /// Unit directions of the first body along which the points do not part: one function each.
  std::vector<Eigen::Vector3d> across{};
  /// Unit directions of the first and of the second body at right angles: one function each.
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> right_angles{};

  Index size() const { return (has_point ? 3 : 0) + static_cast<Index>(across.size() + right_angles.size()); }
};

/// Ball joint, hinge, weld, slider and motion in a plane.
class JointConstraint final : public BodyConstraint {
 public:
  JointConstraint(const std::string& label, Index first, Index second, JointGeometry geometry)
      : BodyConstraint(label, first, second, geometry.size()), geometry_(std::move(geometry)) {}

  bool has_position() const override { return true; }
  void position(double t, const Vector& q, Vector& value) const override;

 protected:
  void fill(const Bodies& bodies, BodyRows& rows) const override;

 private:
  JointGeometry geometry_;
};

/// A point of one body at a distance from one of another.
class RodConstraint final : public BodyConstraint {
 public:
  RodConstraint(const std::string& label, Index first, Index second, const Eigen::Vector3d& first_point,
                const Eigen::Vector3d& second_point, double length)
      : BodyConstraint(label, first, second, 1),
        first_point_(first_point),
        second_point_(second_point),
        length_(length) {}

  bool has_position() const override { return true; }
  void position(double t, const Vector& q, Vector& value) const override;

 protected:
  void fill(const Bodies& bodies, BodyRows& rows) const override;

 private:
  Eigen::Vector3d first_point_;
  Eigen::Vector3d second_point_;
  double length_;
};

}  // namespace hybrid_sphere::mechanics
