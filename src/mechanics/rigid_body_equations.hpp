#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hybrid_sphere/mechanics/equations_of_motion.hpp"
#include "hybrid_sphere/mechanics/model.hpp"
#include "hybrid_sphere/mechanics/rigid_body.hpp"
#include "mechanics/body_motion.hpp"
#include "mechanics/interaction.hpp"

namespace hybrid_sphere::mechanics {

/// The Newton-Euler equations of rigid bodies, by hand:
///   m x'' = m g + F,   I w' = -w x I w + R^T T,   x' = v,   quaternion' = quaternion (0, w) / 2.
/// The potential energy of interactions is part of L, and their forces are part of F and T.
/// Source: docs/theory.md 7.10.
class RigidBodyEquations final : public EquationsOfMotion {
 public:
  struct Body {
    std::string name;
    double mass;              // [kg]
    Eigen::Matrix3d inertia;  // [kg m^2]
    /// Moments that stand in about the axes of the body about which a thin rod or a point mass has none; part
    /// of `inertia`. No part acts on the rotation about these axes, which is 0: their value changes no
    /// motion. 0 for other axes [kg m^2]
    Eigen::Vector3d stand_in = Eigen::Vector3d::Zero();
    std::vector<WrenchFunction> wrenches{};
    std::string label{};  ///< what NotFinite reports for its wrenches; add() sets it
  };

  /// Those of a MultibodySystem. Throws std::invalid_argument if they are others.
  static const RigidBodyEquations& of(const Model& model);

  explicit RigidBodyEquations(const Eigen::Vector3d& gravity) : gravity_(gravity) {}

  void add(Body body) {
    body.label = "wrench of body " + body.name;
    bodies_.push_back(std::move(body));
  }
  const Body& body(Index i) const { return bodies_[static_cast<std::size_t>(i)]; }
  void apply(Index body, WrenchFunction wrench) {
    bodies_[static_cast<std::size_t>(body)].wrenches.push_back(std::move(wrench));
  }
  void add(std::shared_ptr<const Interaction> interaction) {
    interactions_.push_back(std::move(interaction));
  }

  Index count() const { return static_cast<Index>(bodies_.size()); }
  Index coordinates() const override { return body_coordinates * count(); }
  Index velocities() const override { return body_velocities * count(); }
  Index mass_block() const override { return body_velocities; }
  void evaluate(double t, const Vector& q, const Vector& v, MotionTerms& terms) const override;
  void momentum(double t, const Vector& q, const Vector& v, Vector& p, Matrix& mass) const override;
  void rate(const Vector& q, const Vector& v, Vector& rate) const override;
  void directions(const Vector& q, const Vector& v, Matrix& directions, Vector& drift) const override;
  /// Axes that turn in the world like the motion. In a motion straight ahead they do not turn.
  void steady_axes(const Vector& q, const Vector& v, const Vector& acceleration, Matrix& axes,
                   Matrix& axes_rate) const override;

 private:
  /// What acts on a body.
  struct Source {
    const std::string& label;
    double distance;  ///< largest coordinate of the bodies that it acts on, for the round-off of arms [m]
  };

  /// Adds what is applied to a body. @param force  its six components
  void add_wrenches(double t, const Vector& q, const Vector& v, Index body, Vector& force) const;

  /// Adds a wrench about the centre of mass. Throws Undefined for a torque about an axis without a moment of
  /// inertia.
  void add_to_body(Index body, const BodyMotion& motion, const Wrench& wrench, const Source& source,
                   Vector& force) const;
  /// Adds the forces between bodies, and subtracts their potential energy from L.
  void add_interactions(double t, const Vector& q, const Vector& v, MotionTerms& terms) const;

  /// The angular velocity of axes in which the motion is constant but for bodies that spin about an axis of
  /// symmetry: the shortest that fits best, in the world [rad/s].
  Eigen::Vector3d turning_of_motion(const Vector& q, const Vector& v, const Vector& acceleration) const;

  Eigen::Vector3d gravity_;
  std::vector<Body> bodies_;
  std::vector<std::shared_ptr<const Interaction>> interactions_;
};

/// Where body i is, and how it moves.
BodyState state_of_body(Index body, const Vector& q, const Vector& v);
Eigen::Isometry3d pose_of_body(Index body, const Vector& q);

}  // namespace hybrid_sphere::mechanics
