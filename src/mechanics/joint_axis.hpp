#pragma once

#include <array>
#include <memory>
#include <string>

#include "mechanics/interaction.hpp"

namespace hybrid_sphere::mechanics {

/// The coordinate of a joint at one state: the angle of a hinge [rad], or the displacement of a slider [m].
struct AxisMotion {
  double value;
  double rate;                            ///< for the rate of q
  Eigen::Matrix<double, 1, 12> gradient;  ///< of the rate by v1, w1, v2, w2
  double acceleration;                    ///< change of the rate at constant v and w, for the rate of q
};

/// The axis of a hinge or of a slider, on the axes of its two bodies. Source: docs/theory.md 7.10.
struct JointAxis {
  using Bodies = std::array<BodyMotion, 2>;

  std::string joint;
  bool is_hinge;
  std::array<Index, 2> bodies;
  Eigen::Vector3d axis;       ///< of the first body, of unit length
  Eigen::Vector3d across;     ///< of the first body, of unit length, at a right angle to the axis
  Eigen::Vector3d reference;  ///< of the second body: parallel to `across` at angle 0
  Eigen::Vector3d first_point;
  Eigen::Vector3d second_point;

  /// Bodies at rest.
  Bodies at(const Vector& q) const { return {BodyMotion::at(bodies[0], q), BodyMotion::at(bodies[1], q)}; }
  /// Bodies that move with their velocities.
  Bodies at(const Vector& q, const Vector& v) const;
  /// Bodies that move at any rate of q.
  Bodies moving(const Vector& q, const Vector& rate) const;

  AxisMotion motion(const Bodies& bodies) const { return is_hinge ? angle(bodies) : displacement(bodies); }

 private:
  AxisMotion angle(const Bodies& bodies) const;
  AxisMotion displacement(const Bodies& bodies) const;
};

/// A torque about the axis of a hinge, or a force along that of a slider, on its second body.
class DriveInteraction final : public Interaction {
 public:
  DriveInteraction(const std::string& label, std::shared_ptr<const JointAxis> axis, DriveFunction function)
      : Interaction(label, axis->bodies[0], axis->bodies[1]),
        axis_(std::move(axis)),
        function_(std::move(function)) {}
  Wrench wrench(double t, const Bodies& bodies) const override;

 private:
  std::shared_ptr<const JointAxis> axis_;
  DriveFunction function_;
};

}  // namespace hybrid_sphere::mechanics
