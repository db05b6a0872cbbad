#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hybrid_sphere/mechanics/equations_of_motion.hpp"
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
    double mass;
    Eigen::Matrix3d inertia;
    std::vector<WrenchFunction> wrenches{};
  };

  explicit RigidBodyEquations(const Eigen::Vector3d& gravity) : gravity_(gravity) {}

  void add(Body body) { bodies_.push_back(std::move(body)); }
  void apply(Index body, WrenchFunction wrench) {
    bodies_[static_cast<std::size_t>(body)].wrenches.push_back(std::move(wrench));
  }
  void add(std::shared_ptr<const Interaction> interaction) {
    interactions_.push_back(std::move(interaction));
  }

  Index coordinates() const override { return body_coordinates * count(); }
  Index velocities() const override { return body_velocities * count(); }
  void evaluate(double t, const Vector& q, const Vector& v, MotionTerms& terms) const override;
  void momentum(double t, const Vector& q, const Vector& v, Vector& p, Matrix& mass) const override;
  void rate(const Vector& q, const Vector& v, Vector& rate) const override;
  void directions(const Vector& q, const Vector& v, Matrix& directions, Vector& drift) const override;

 private:
  Index count() const { return static_cast<Index>(bodies_.size()); }
  /// Adds what is applied to a body. @param force  its six components
  void add_wrenches(double t, const Vector& q, const Vector& v, Index body, Vector& force) const;

  /// Adds the forces between bodies, and subtracts their potential energy from L.
  void add_interactions(double t, const Vector& q, const Vector& v, MotionTerms& terms) const;

  Eigen::Vector3d gravity_;
  std::vector<Body> bodies_;
  std::vector<std::shared_ptr<const Interaction>> interactions_;
};

/// Where body i is, and how it moves.
BodyState state_of_body(Index body, const Vector& q, const Vector& v);
Eigen::Isometry3d pose_of_body(Index body, const Vector& q);

}  // namespace hybrid_sphere::mechanics
