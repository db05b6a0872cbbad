#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <string>

/// What the parts of a MultibodySystem are described by.
namespace hybrid_sphere::mechanics {

/// Moments of inertia about a centre of mass, on the axes of the body [kg m^2]: the matrix of
/// integral (r^2 1 - r r^T) dm, whose elements off the diagonal are integrals -x y dm.
/// @code
/// const mechanics::Inertia frame(9.2, 11, 2.8, 0, -2.4);
/// const double about_y = frame.matrix(1, 1);
/// @endcode
struct Inertia {
  Eigen::Matrix3d matrix;

  Inertia(double xx, double yy, double zz, double xy = 0, double xz = 0, double yz = 0) {
    matrix << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  }
  explicit Inertia(const Eigen::Matrix3d& elements) : matrix(elements) {}
};

/// A velocity of a body, in the world.
struct Twist {
  Eigen::Vector3d velocity{0, 0, 0};          ///< of the centre of mass [m/s]
  Eigen::Vector3d angular_velocity{0, 0, 0};  ///< [rad/s]
};

/// A force and a torque on a body, in the world.
struct Wrench {
  Eigen::Vector3d force{0, 0, 0};   ///< [N]
  Eigen::Vector3d torque{0, 0, 0};  ///< about the centre of mass [N m]
};

/// Where a body is and how it moves.
struct BodyState {
  Eigen::Isometry3d
      pose;  ///< from the body's axes, with the centre of mass as their origin, to the world [m]
  Twist twist;
};

/// A force and a torque that depend on the time [s] and on the state of their body.
using WrenchFunction = std::function<Wrench(double t, const BodyState& body)>;

/// A force at a point of a body, as a force and a torque about its centre of mass.
/// @param force  in the world [N]
/// @param point  where it acts, in the world [m]
/// @code
/// const auto tow = [](double, const mechanics::BodyState& body) {
///   return mechanics::force_at({100, 0, 0}, body.pose * Eigen::Vector3d(0, 0, 0.5), body);
/// };
/// @endcode
inline Wrench force_at(const Eigen::Vector3d& force, const Eigen::Vector3d& point, const BodyState& body) {
  return {force, (point - body.pose.translation()).cross(force)};
}

/// The force and the torque of a first body on a second one, as functions of the time [s] and of both states:
/// those on the second one, about its centre of mass. The world rests at its origin, with its axes.
using PairWrenchFunction = std::function<Wrench(double t, const BodyState& first, const BodyState& second)>;

/// The torque of a hinge [N m] as a function of the time [s], its angle [rad] and its rate [rad/s], or the
/// force of a slider [N] as a function of the time, its displacement [m] and its rate [m/s].
using DriveFunction = std::function<double(double t, double position, double rate)>;

/// A plane of a body or of the world: by default z = 0, with the bodies above it.
/// @code
/// const mechanics::Plane top_of_plank{{0, 0, 0.1}, {0, 0, 1}, "plank"};
/// @endcode
struct Plane {
  Eigen::Vector3d point{0, 0, 0};   ///< on it, in the world, with the body at its placement [m]
  Eigen::Vector3d normal{0, 0, 1};  ///< to the side of the bodies that touch it, of any length > 0
  std::string body{"world"};        ///< with which it moves; "world": it stands still
};

/// The part of a body that touches a plane or another sphere: a sphere, or the edge of a disk.
/// @code
/// const mechanics::ContactShape wheel = mechanics::ContactShape::disk(0.35, {0, 1, 0});
/// @endcode
struct ContactShape {
  double radius = 1;                        ///< > 0 [m]
  std::optional<Eigen::Vector3d> axle{};    ///< of a disk, of any length > 0; none: it is a sphere
  std::optional<Eigen::Vector3d> center{};  ///< none: the body's centre of mass [m]

  static ContactShape sphere(double radius) { return {radius}; }
  /// @param center  in the world, with the body at its placement
  static ContactShape sphere(double radius, const Eigen::Vector3d& center) {
    return {radius, std::nullopt, center};
  }
  /// @param axle  in the world, with the body at its placement; it rolls along axle x normal where it turns
  ///              about the axle
  static ContactShape disk(double radius, const Eigen::Vector3d& axle) { return {radius, axle}; }
  /// @param center  in the world, with the body at its placement
  static ContactShape disk(double radius, const Eigen::Vector3d& axle, const Eigen::Vector3d& center) {
    return {radius, axle, center};
  }
};

/// A direction along a plane, in which a contact may slip.
enum class Slip {
  along,  ///< of a disk: axle x normal, in which it rolls; of a sphere: the world's x along the plane, or y
          ///< where that is nearer to the plane, which turns with the body of the plane; of two spheres: the
          ///< part across the normal of that axis of the world which is nearest to it at the placements
  across  ///< normal x along
};

}  // namespace hybrid_sphere::mechanics
