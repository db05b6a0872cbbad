#pragma once

#include <Eigen/Core>

#include "hybrid_sphere/mechanics/vector.hpp"

/// Rigid bodies among the coordinates and velocities of a MultibodySystem. Source: docs/theory.md 7.10.
namespace hybrid_sphere::mechanics {

constexpr Index body_coordinates = 7;
constexpr Index body_velocities = 6;
constexpr Index world_body = -1;

/// Of a vector: [r] s = r x s.
Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& r);

/// R from the body's axes to the world for a quaternion w, x, y, z of any length > 0.
Eigen::Matrix3d rotation_of(const Eigen::Vector4d& quaternion);

/// A body, or the world, at one (q, v), moving at one rate of q.
struct BodyMotion {
  Eigen::Vector3d x = Eigen::Vector3d::Zero();       ///< centre of mass, in the world [m]
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();   ///< from the body's axes to the world
  Eigen::Vector3d v = Eigen::Vector3d::Zero();       ///< of the centre of mass, in the world [m/s]
  Eigen::Vector3d w = Eigen::Vector3d::Zero();       ///< angular velocity, on the body's axes [rad/s]
  Eigen::Vector3d x_rate = Eigen::Vector3d::Zero();  ///< x' for the rate of q
  Eigen::Matrix3d R_rate = Eigen::Matrix3d::Zero();  ///< R' for the rate of q

  /// @param body  its index, or world_body
  static BodyMotion at(Index body, const Vector& q);
  static BodyMotion at(Index body, const Vector& q, const Vector& v);
  /// With x' and R' for the rate of q that the velocities make.
  void move();
  /// With x' and R' for any rate of q.
  void move(Index body, const Vector& q, const Vector& rate);
};

/// A point of a body: where it is, and how it moves.
struct PointMotion {
  Eigen::Vector3d place;         ///< in the world [m]
  Eigen::Vector3d rate;          ///< for the rate of q [m/s]
  Eigen::Matrix3d by_w;          ///< d(velocity)/dw; that by v is the unit matrix
  Eigen::Vector3d acceleration;  ///< change of the velocity at constant v and w, for the rate of q [m/s^2]

  /// @param r  on the body's axes, from the centre of mass [m]
  PointMotion(const BodyMotion& body, const Eigen::Vector3d& r);
};

/// A direction of a body.
struct DirectionMotion {
  Eigen::Vector3d direction;     ///< in the world
  Eigen::Vector3d rate;          ///< for the rate of q
  Eigen::Matrix3d by_w;          ///< d(its derivative)/dw
  Eigen::Vector3d acceleration;  ///< change of its derivative at constant w, for the rate of q

  /// @param d  on the body's axes
  DirectionMotion(const BodyMotion& body, const Eigen::Vector3d& d);
};

}  // namespace hybrid_sphere::mechanics
