#pragma once

#include <optional>

#include "hybrid_sphere/mechanics/rigid_body.hpp"
#include "mechanics/body_constraint.hpp"

namespace hybrid_sphere::mechanics {

/// A sphere or the edge of a disk on a plane.
struct ContactGeometry {
  Eigen::Vector3d center;  ///< on the body's axes, from the centre of mass [m]
  Eigen::Vector3d axle;    ///< on the body's axes, of unit length; 0: a sphere
  double radius;           ///< [m]
  Eigen::Vector3d point;   ///< of the plane, in the world [m]
  Eigen::Vector3d normal;  ///< of the plane, in the world, of unit length

  bool is_disk() const { return axle != Eigen::Vector3d::Zero(); }
};

/// The point of the body that is nearest to the plane, and how far it is above it.
struct ContactMotion {
  double gap;                    ///< [m]
  double gap_rate;               ///< for the rate of q [m/s]
  Eigen::Vector3d velocity;      ///< of the body there; along the normal, of positions: the gap's rate [m/s]
  Eigen::Matrix3d by_w;          ///< d(velocity)/dw; that by v is the unit matrix
  Eigen::Vector3d acceleration;  ///< change of the velocity at constant v and w, for the rate of q [m/s^2]

  ContactMotion(const ContactGeometry& geometry, const BodyMotion& body);
};

/// No velocity of the point of contact: three functions.
class RollingConstraint final : public BodyConstraint {
 public:
  RollingConstraint(const std::string& label, Index body, ContactGeometry geometry)
      : BodyConstraint(label, body, world_body, 3), geometry_(std::move(geometry)) {}

  bool has_position() const override { return true; }
  void position(double t, const Vector& q, Vector& value) const override;

 protected:
  void fill(const Bodies& bodies, BodyRows& rows) const override;

 private:
  ContactGeometry geometry_;
};

/// The gap of a contact.
class GapConstraint final : public BodyConstraint {
 public:
  GapConstraint(const std::string& label, Index body, ContactGeometry geometry)
      : BodyConstraint(label, body, world_body, 1), geometry_(std::move(geometry)) {}

  bool has_position() const override { return true; }
  void position(double t, const Vector& q, Vector& value) const override;

 protected:
  void fill(const Bodies& bodies, BodyRows& rows) const override;

 private:
  ContactGeometry geometry_;
};

/// Its guard, less the gap.
class GapGuard final : public Guard {
 public:
  GapGuard(std::string label, Index body, ContactGeometry geometry)
      : label_(std::move(label)), body_(body), geometry_(std::move(geometry)) {}

  double value(double t, const Vector& q) const override;
  double rate(double t, const Vector& q, const Vector& q_rate) const override;

 private:
  ContactMotion motion(const Vector& q, const Vector& q_rate) const;

  std::string label_;
  Index body_;
  ContactGeometry geometry_;
};

/// The velocity of the point of contact in one direction along the plane, or in both.
class SlipConstraint final : public BodyConstraint {
 public:
  /// @param slip  none: along and across
  SlipConstraint(const std::string& label, Index body, ContactGeometry geometry, std::optional<Slip> slip)
      : BodyConstraint(label, body, world_body, slip ? 1 : 2),
        geometry_(std::move(geometry)),
        slip_(slip) {}

 protected:
  void fill(const Bodies& bodies, BodyRows& rows) const override;

 private:
  ContactGeometry geometry_;
  std::optional<Slip> slip_;
};

/// The velocity of a point of a body along a plane, to the left of a direction of the body.
class BladeConstraint final : public BodyConstraint {
 public:
  /// @param point, direction  on the body's axes @param normal  in the world, of unit length
  BladeConstraint(const std::string& label, Index body, const Eigen::Vector3d& point,
                  const Eigen::Vector3d& direction, const Eigen::Vector3d& normal)
      : BodyConstraint(label, body, world_body, 1), point_(point), direction_(direction), normal_(normal) {}

 protected:
  void fill(const Bodies& bodies, BodyRows& rows) const override;

 private:
  Eigen::Vector3d point_;
  Eigen::Vector3d direction_;
  Eigen::Vector3d normal_;
};

/// A guard of one body, whose seven coordinates it is a function of.
class BodyGuard final : public Guard {
 public:
  BodyGuard(Index body, std::shared_ptr<const Guard> guard) : body_(body), guard_(std::move(guard)) {}

  double value(double t, const Vector& q) const override { return guard_->value(t, part(q)); }
  double rate(double t, const Vector& q, const Vector& q_rate) const override {
    return guard_->rate(t, part(q), part(q_rate));
  }

 private:
  Vector part(const Vector& q) const { return q.segment<body_coordinates>(body_coordinates * body_); }

  Index body_;
  std::shared_ptr<const Guard> guard_;
};

}  // namespace hybrid_sphere::mechanics
