#pragma once

#include <array>
#include <string>

#include "hybrid_sphere/mechanics/rigid_body.hpp"
#include "mechanics/body_motion.hpp"

namespace hybrid_sphere::mechanics {

/// A force and a torque between two bodies, of which one may be the world. The first body gets the opposite
/// of the second one along the same line, so that they keep their momentum and their angular momentum.
/// Source: docs/theory.md 7.10.
class Interaction {
 public:
  using Bodies = std::array<BodyMotion, 2>;

  /// @param label  the name that NotFinite reports: "spring front"
  Interaction(std::string label, Index first, Index second)
      : label_(std::move(label)), bodies_{first, second} {}
  virtual ~Interaction() = default;

  const std::string& label() const { return label_; }
  /// Index of a body, or world_body. @param i  0: the first one, 1: the second one
  Index body(std::size_t i) const { return bodies_[i]; }

  /// The force and the torque on the second body, in the world [N, N m]; the torque is about its centre of
  /// mass, or about the origin if it is the world. Throws NotFinite.
  virtual Wrench wrench(double t, const Bodies& bodies) const = 0;
  /// Potential energy [J]; 0 if the force has none.
  virtual double potential(const Bodies& /*bodies*/) const { return 0; }

 private:
  std::string label_;
  std::array<Index, 2> bodies_;
};

/// The state of a body at the velocities of its motion.
BodyState state_of(const BodyMotion& body);

/// A function of the caller.
class AppliedInteraction final : public Interaction {
 public:
  AppliedInteraction(const std::string& label, Index first, Index second, PairWrenchFunction function)
      : Interaction(label, first, second), function_(std::move(function)) {}
  Wrench wrench(double t, const Bodies& bodies) const override {
    return function_(t, state_of(bodies[0]), state_of(bodies[1]));
  }

 private:
  PairWrenchFunction function_;
};

/// The points of two bodies between which a spring or a damper acts, on the axes of the bodies [m].
struct LinePoints {
  Eigen::Vector3d first;
  Eigen::Vector3d second;
};

/// A spring that pulls with stiffness (length - natural length) along the line between two points.
class SpringInteraction final : public Interaction {
 public:
  SpringInteraction(const std::string& label, Index first, Index second, LinePoints points, double stiffness,
                    double natural_length)
      : Interaction(label, first, second),
        points_(std::move(points)),
        stiffness_(stiffness),
        natural_length_(natural_length) {}
  Wrench wrench(double t, const Bodies& bodies) const override;
  double potential(const Bodies& bodies) const override;

 private:
  LinePoints points_;
  double stiffness_;       // [N/m]
  double natural_length_;  // [m]
};

/// A damper that resists a change of the distance between two points.
class DamperInteraction final : public Interaction {
 public:
  DamperInteraction(const std::string& label, Index first, Index second, LinePoints points,
                    double coefficient)
      : Interaction(label, first, second), points_(std::move(points)), coefficient_(coefficient) {}
  Wrench wrench(double t, const Bodies& bodies) const override;

 private:
  LinePoints points_;
  double coefficient_;  // [N s/m]
};

}  // namespace hybrid_sphere::mechanics
