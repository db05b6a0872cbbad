#pragma once

#include <optional>

#include "hybrid_sphere/mechanics/rigid_body.hpp"
#include "mechanics/body_constraint.hpp"

namespace hybrid_sphere::mechanics {

/// A sphere or the edge of a disk of a first body on a plane of a second one, or two spheres.
struct ContactGeometry {
  Eigen::Vector3d center;  ///< on the axes of the first body, from its centre of mass [m]
  Eigen::Vector3d axle;    ///< on the axes of the first body, of unit length; 0: a sphere
  double radius;           ///< [m]
  Eigen::Vector3d point;   ///< on the axes of the second body: of the plane, or the second centre [m]
  Eigen::Vector3d normal;  ///< of the plane, on the axes of the second body, of unit length
  /// A sphere's Slip::along is its part along the surface; as `normal`, for two spheres in the world.
  Eigen::Vector3d axis;
  std::optional<double> second_radius{};  ///< of a second sphere; none: a plane [m]

  bool is_disk() const { return axle != Eigen::Vector3d::Zero(); }
};

/// A unit vector in the world, and its rate.
struct MovingDirection {
  Eigen::Vector3d direction;
  Eigen::Vector3d rate;
};

/// The velocity of a point of the first body relative to the material of the second one at the same place.
struct RelativeVelocity {
  Eigen::Vector3d velocity;      ///< [m/s]
  Eigen::Matrix3d by_w;          ///< d(velocity)/dw; that by v is the unit matrix
  Eigen::Matrix3d by_second_w;   ///< the same of the second body; that by its v is minus the unit matrix
  Eigen::Vector3d acceleration;  ///< change of the velocity at constant v and w, for the rate of q [m/s^2]

  /// Subtracts the velocity of the second body. @param place_rate  of the place, for the rate of q
  void subtract(const BodyMotion& second, const Eigen::Vector3d& place, const Eigen::Vector3d& place_rate);
};

/// The point of the first body that is nearest to the surface of the second one, and its height above it.
struct ContactMotion {
  double gap;       ///< [m]
  double gap_rate;  ///< for the rate of q [m/s]
  MovingDirection normal;
  RelativeVelocity point;  ///< along the normal, the velocity is that of positions: the gap's rate

  ContactMotion(const ContactGeometry& geometry, const BodyMotion& first, const BodyMotion& second);
};

/// No relative velocity at the point of contact: three functions.
class RollingConstraint final : public BodyConstraint {
 public:
  RollingConstraint(const std::string& label, Index first, Index second, ContactGeometry geometry)
      : BodyConstraint(label, first, second, 3), geometry_(std::move(geometry)) {}

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
  GapConstraint(const std::string& label, Index first, Index second, ContactGeometry geometry)
      : BodyConstraint(label, first, second, 1), geometry_(std::move(geometry)) {}

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
  GapGuard(std::string label, Index first, Index second, ContactGeometry geometry)
      : label_(std::move(label)), first_(first), second_(second), geometry_(std::move(geometry)) {}

  double value(double t, const Vector& q) const override;
  double rate(double t, const Vector& q, const Vector& q_rate) const override;

 private:
  std::string label_;
  Index first_;
  Index second_;
  ContactGeometry geometry_;
};

/// The relative velocity at the point of contact in one direction along the surface, or in both.
class SlipConstraint final : public BodyConstraint {
 public:
  /// @param slip  none: along and across
  SlipConstraint(const std::string& label, Index first, Index second, ContactGeometry geometry,
                 std::optional<Slip> slip)
      : BodyConstraint(label, first, second, slip ? 1 : 2), geometry_(std::move(geometry)), slip_(slip) {}

 protected:
  void fill(const Bodies& bodies, BodyRows& rows) const override;

 private:
  ContactGeometry geometry_;
  std::optional<Slip> slip_;
};

/// The velocity of a point of the first body along a plane of the second one, to the left of a direction of
/// the first.
class BladeConstraint final : public BodyConstraint {
 public:
  /// @param point, direction  on the axes of the first body
  /// @param normal  on the axes of the second one, of unit length
  BladeConstraint(const std::string& label, Index first, Index second, const Eigen::Vector3d& point,
                  const Eigen::Vector3d& direction, const Eigen::Vector3d& normal)
      : BodyConstraint(label, first, second, 1), point_(point), direction_(direction), normal_(normal) {}

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
