#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hybrid_sphere/export.hpp"
#include "hybrid_sphere/mechanics/rigid_body.hpp"
#include "hybrid_sphere/mechanics/solution.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics {

class Interaction;
struct ContactGeometry;
struct JointAxis;
struct JointGeometry;

/// When a constraint of a MultibodySystem holds: always(), from(t), between(t1, t2), or while_positive(g)
/// with a function g(t, q) of the time and of the seven coordinates x, y, z, qw, qx, qy, qz of one body: the
/// first that the constraint names and that is not the world.
/// @code
/// const mechanics::When in_snow =
///     mechanics::while_positive([](auto, const auto& q) { return (q[0] - 2) * (3.5 - q[0]); });
/// @endcode
class When {
 public:
  When(const Between& interval) : begin_(interval.begin), end_(interval.end) {}
  template <class Function>
  When(const WhilePositive<Function>& condition)
      : guard_([guard = condition.guard](const std::string& label) {
          return automatic_guard<7>(label, guard);
        }) {}
  /// Within an interval, while a guard whose derivatives are supplied by hand is positive. @param by_hand  a
  /// function of the seven coordinates; null: none
  When(const Between& interval, std::shared_ptr<const Guard> by_hand) : When(interval) {
    if (by_hand) guard_ = [by_hand = std::move(by_hand)](const std::string&) { return by_hand; };
  }

  double begin() const { return begin_; }  ///< [s]
  double end() const { return end_; }      ///< [s]
  /// The guard as a function of the coordinates of the body; null: there is none.
  std::shared_ptr<const Guard> guard(const std::string& label) const {
    return guard_ ? guard_(label) : nullptr;
  }

 private:
  double begin_ = always().begin;
  double end_ = always().end;
  std::function<std::shared_ptr<const Guard>(const std::string& label)> guard_;
};

/// A hybrid system of rigid bodies, with joints, forces and contacts between them and with the world: a Model
/// that needs no Lagrangian. Source: docs/theory.md 7.10.
///
/// Each body has seven coordinates, the place of its centre of mass in the world and the unit quaternion that
/// turns its axes into the world's, NAME.x, .y, .z [m], .qw, .qx, .qy, .qz, and six velocities, that of the
/// centre of mass in the world, NAME.vx, .vy, .vz [m/s], and the angular velocity on the body's axes,
/// NAME.w1, .w2, .w3 [rad/s]. The bodies follow one another in q and v as they were added.
///
/// A body is added with a placement. Points and directions of joints and contacts are given in the world,
/// with all bodies at their placements; from there on they move with their bodies. Multipliers are forces [N]
/// and torques [N m], as each part says. Constraints that say the same are no fault: the motion is unique,
/// and the multipliers are those of least norm.
///
/// All functions throw std::invalid_argument, with name, value and what is allowed: for a body that there is
/// not, numbers that are not finite, directions and normals without a length, radii and distances that are
/// not > 0.
/// @code
/// mechanics::MultibodySystem pendulum;  // with gravity along -z
/// pendulum.body("rod", 2, {0.17, 0.17, 0.001}, Eigen::Vector3d(0, 0, -0.5));
/// pendulum.hinge("pivot", "world", "rod", {0, 0, 0}, {0, 1, 0});
/// const mechanics::Initial start = pendulum.initial({{"rod", {{-0.5, 0, 0}, {0, 1, 0}}}});
/// @endcode
class HYBRID_SPHERE_EXPORT MultibodySystem : public Model {
 public:
  /// @param gravity  in the world [m/s^2]
  explicit MultibodySystem(const Eigen::Vector3d& gravity = Eigen::Vector3d(0, 0, -9.81));

  /// Adds a body with the axes of its placement. Refuses an empty name or "world", a name that there is
  /// already, a mass that is not > 0, and an inertia that no rigid body has.
  /// @param mass       [kg]
  /// @param inertia    about the centre of mass, on the body's axes [kg m^2]
  /// @param placement  from the body's axes, with the centre of mass as their origin, to the world [m]
  MultibodySystem& body(const std::string& name, double mass, const Inertia& inertia,
                        const Eigen::Isometry3d& placement);
  /// The same with axes along the world's. @param center  of mass, in the world [m]
  MultibodySystem& body(const std::string& name, double mass, const Inertia& inertia,
                        const Eigen::Vector3d& center);

  /// A body without moments of inertia. Its attitude has no meaning and does not change. Only parts that act
  /// at its position are allowed: ball joints, rods, springs and dampers there, and contacts. Others, such as
  /// a weld, a hinge or a friction, are refused. A torque on it by apply() ends the motion (Stop::undefined).
  /// @param mass  [kg] @param position  in the world [m]
  MultibodySystem& point_mass(const std::string& name, double mass, const Eigen::Vector3d& position);
  /// A straight homogeneous rod without a moment of inertia about its own line, which is the z axis of the
  /// body; mass length^2 / 12 about axes across it. Its rotation about the line has no meaning and is 0. Only
  /// parts that act at points of the line are allowed, as for a point mass.
  /// @param mass  [kg] @param first_end, second_end  in the world [m]
  MultibodySystem& thin_rod(const std::string& name, double mass, const Eigen::Vector3d& first_end,
                            const Eigen::Vector3d& second_end);

  /// A force and a torque on a body that stay as they are in the world [N, N m]. @param wrench  about the
  /// centre of mass
  MultibodySystem& apply(const std::string& body, const Wrench& wrench);
  /// A force and a torque on a body. @param wrench  a function of the time [s] and of the body's state
  MultibodySystem& apply(const std::string& body, WrenchFunction wrench);
  /// A force and a torque between two bodies, of which one may be "world". The first one gets the opposite,
  /// along the same line of action: both together keep their momentum and their angular momentum.
  /// @param wrench  on the second body, about its centre of mass; see force_at() for a force at a point
  MultibodySystem& apply(const std::string& first, const std::string& second, PairWrenchFunction wrench);

  /// A spring between points of two bodies, of which one may be "world". It pulls with
  /// stiffness (length - natural_length) along the line between them. Its potential energy,
  /// stiffness (length - natural_length)^2 / 2, is part of State::energy. A natural length of 0 is allowed.
  /// Otherwise the points must not coincide at the placements, and a motion in which they meet ends there
  /// (Stop::undefined). @param stiffness  > 0 [N/m] @param natural_length  >= 0 [m]
  MultibodySystem& spring(const std::string& name, const std::string& first, const std::string& second,
                          const Eigen::Vector3d& point_of_first, const Eigen::Vector3d& point_of_second,
                          double stiffness, double natural_length);
  /// A damper between points of two bodies, as a spring. It pulls with coefficient times the rate of its
  /// length. @param coefficient  > 0 [N s/m]
  MultibodySystem& damper(const std::string& name, const std::string& first, const std::string& second,
                          const Eigen::Vector3d& point_of_first, const Eigen::Vector3d& point_of_second,
                          double coefficient);

  // Joints between two bodies, of which one may be "world". Where they are applied later than at the
  // placement the bodies have to be where they hold by then.

  /// A point of both bodies in common; three functions, lambda: the force on the second one, in the world.
  MultibodySystem& ball(const std::string& name, const std::string& first, const std::string& second,
                        const Eigen::Vector3d& point, const When& when = always());
  /// An axis in common; five functions, lambda: as of a ball, and the torques on the second body about two
  /// directions across the axis. @param axis  of any length > 0
  MultibodySystem& hinge(const std::string& name, const std::string& first, const std::string& second,
                         const Eigen::Vector3d& point, const Eigen::Vector3d& axis,
                         const When& when = always());
  /// No motion relative to each other; six functions, lambda: force as of a ball, and torques on the second
  /// body about the axes of the first one.
  MultibodySystem& weld(const std::string& name, const std::string& first, const std::string& second,
                        const Eigen::Vector3d& point, const When& when = always());
  /// Only a translation along an axis relative to each other; five functions, lambda: the forces on the
  /// second body along two directions across the axis, and torques as of a weld. @param point  where these
  /// act
  MultibodySystem& slider(const std::string& name, const std::string& first, const std::string& second,
                          const Eigen::Vector3d& point, const Eigen::Vector3d& axis,
                          const When& when = always());
  /// Only motions in a plane relative to each other; three functions, lambda: the force on the second body
  /// along the normal, and torques about two directions across it. @param point  where this acts
  MultibodySystem& planar(const std::string& name, const std::string& first, const std::string& second,
                          const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                          const When& when = always());
  /// The distance of two points stays; one function, lambda: the force that drives them apart.
  MultibodySystem& rod(const std::string& name, const std::string& first, const std::string& second,
                       const Eigen::Vector3d& point_of_first, const Eigen::Vector3d& point_of_second,
                       const When& when = always());

  // Drives and limits of a hinge or of a slider that has been added before. They act at all times, also while
  // the joint does not hold.

  /// A motor, a torsion spring or a brake in a hinge. @param torque  on the second body about the axis
  MultibodySystem& torque(const std::string& hinge, DriveFunction torque);
  /// The same in a slider. @param force  on the second body along the axis
  MultibodySystem& force(const std::string& slider, DriveFunction force);
  /// Stops a joint at the ends of a range (Unilateral). It adds the constraints JOINT.lower and JOINT.upper;
  /// one function each, lambda: the torque or the force on the second body, away from the end.
  /// @param lower, upper  of angle() or displacement(); lower < upper; for a hinge between -pi and pi, for a
  ///                      slider also infinite: then without this end [rad or m]
  /// @param restitution   0 to 1
  MultibodySystem& limit(const std::string& joint, double lower, double upper, double restitution = 0);

  // Contacts of a body with a plane of the world or of another body, which gets the opposite force.
  // Velocities are those of the body relative to the material of the other one at the point of contact.

  /// Rolls without slipping, and does not leave the plane; three functions, the velocity of the point of
  /// contact in the world, lambda: the force on the body there, in the world. A disk must not lie flat.
  /// @code
  /// mechanics::MultibodySystem system;
  /// system.body("plank", 3, {0.1, 1, 1.1}, Eigen::Vector3d(0, 0, 0.05))
  ///     .body("ball", 1, {0.004, 0.004, 0.004}, Eigen::Vector3d(0, 0, 0.2))
  ///     .planar("ice", "world", "plank", {0, 0, 0}, {0, 0, 1})
  ///     .rolling("on the plank", "ball", mechanics::ContactShape::sphere(0.1), mechanics::always(),
  ///              {{0, 0, 0.1}, {0, 0, 1}, "plank"});
  /// @endcode
  MultibodySystem& rolling(const std::string& name, const std::string& body, const ContactShape& shape,
                           const When& when = always(), const Plane& plane = {});
  /// A skate: a point of the body has no velocity across a direction of the body, along the plane; one
  /// function, lambda: the force on the body to the left of the direction, seen from the normal. What keeps
  /// the point on the plane is another part. @param direction  not along the normal
  MultibodySystem& blade(const std::string& name, const std::string& body, const Eigen::Vector3d& point,
                         const Eigen::Vector3d& direction, const When& when = always(),
                         const Plane& plane = {});
  /// Lands on the plane, presses and lifts off (Unilateral); one function, lambda: the force along the
  /// normal.
  /// @param restitution  0 to 1
  MultibodySystem& contact(const std::string& name, const std::string& body, const ContactShape& shape,
                           double restitution = 0, const Plane& plane = {});
  /// A contact of two spheres of two bodies, of which the second may be "world"; lambda: the force that
  /// drives them apart. A friction of it is undefined where the line of the centres is along the axis that
  /// Slip::along is measured from: a motion in which they touch there ends (Stop::undefined).
  /// @param restitution  0 to 1
  MultibodySystem& contact(const std::string& name, const std::string& first,
                           const ContactShape& sphere_of_first, const std::string& second,
                           const ContactShape& sphere_of_second, double restitution = 0);
  /// Coulomb friction of a contact(), in all directions along its surface (Friction); two functions, lambda:
  /// the force on the body along Slip::along and Slip::across. A contact has one friction.
  /// @param contact  name of the contact
  /// @param coefficient         >= 0
  /// @param static_coefficient  of what sticks, >= coefficient; none: the same
  MultibodySystem& friction(const std::string& name, const std::string& contact, double coefficient,
                            std::optional<double> static_coefficient = {});
  /// The same in one direction only, without any across it; one function.
  MultibodySystem& friction(const std::string& name, const std::string& contact, Slip direction,
                            double coefficient, std::optional<double> static_coefficient = {});

  /// The start at t = 0 at the placements. Bodies that are named have the velocities given; those of the
  /// others are the ones of least kinetic energy that the constraints which hold there allow. Refuses a body
  /// named twice, and velocities that the constraints do not allow, with the constraint and by how much.
  Initial initial(const std::vector<std::pair<std::string, Twist>>& velocities = {}) const;

  /// From a body's axes to the world. @param q  (N)
  Eigen::Isometry3d pose(const Vector& q, const std::string& body) const;
  /// Of all bodies, in their order: what SystemPlugin::poses() returns.
  std::vector<Eigen::Isometry3d> poses(const Vector& q) const;
  /// Velocity of the centre of mass and angular velocity, in the world. @param v  (n)
  Twist twist(const Vector& q, const Vector& v, const std::string& body) const;
  /// Velocity of a point of a body, in the world [m/s]. @param point  on the body's axes, from the centre of
  /// mass [m]
  Eigen::Vector3d velocity(const Vector& q, const Vector& v, const std::string& body,
                           const Eigen::Vector3d& point) const;

  /// Angle by which the second body of a hinge is turned about the axis, relative to the first one; 0 at the
  /// placements; in (-pi, pi] [rad]
  double angle(const Vector& q, const std::string& hinge) const;
  /// Rate of the angle [rad/s]
  double angle_rate(const Vector& q, const Vector& v, const std::string& hinge) const;
  /// Distance by which the second body of a slider has moved along the axis, relative to the first one; 0 at
  /// the placements [m]
  double displacement(const Vector& q, const std::string& slider) const;
  /// Rate of the displacement [m/s]
  double displacement_rate(const Vector& q, const Vector& v, const std::string& slider) const;

 private:
  struct Touching {
    std::string constraint;
    Index first;
    Index second;
    std::shared_ptr<const ContactGeometry> geometry;
  };
  enum class JointKind { hinge, slider, any };
  using JointParts = std::function<void(const Eigen::Isometry3d& first, const Eigen::Isometry3d& second,
                                        JointGeometry& joint)>;

  Index index_of(const std::string& subject, const std::string& body) const;  // -1: the world
  Index index_of_body(const std::string& subject, const std::string& body) const;
  std::pair<Index, Index> pair_of(const std::string& subject, const std::string& first,
                                  const std::string& second) const;
  std::string subject_of_body(const std::string& name, double mass) const;  // refuses both
  MultibodySystem& add_body(const std::string& name, double mass, const Eigen::Matrix3d& moments,
                            const Eigen::Vector3d& stand_in, const Eigen::Isometry3d& placement);
  // Rotations of point masses, and of thin rods about their lines: they have no moment of inertia.
  void refuse_unseen_rotations(const std::string& subject, const ConstraintFunction& function) const;
  void stop_unseen_rotations(Vector& v) const;
  Vector placed() const;  // q at the placements
  Eigen::Isometry3d placement(Index body) const;
  MultibodySystem& add(std::shared_ptr<const Interaction> interaction);
  MultibodySystem& add(const std::string& name, std::shared_ptr<const ConstraintFunction> function,
                       const When& when, Index guarded);
  MultibodySystem& add_contact(const std::string& name, Index first, Index second, double restitution,
                               const ContactGeometry& geometry);
  MultibodySystem& add_friction(const std::string& name, const std::string& contact,
                                std::optional<Slip> direction, Friction law);
  MultibodySystem& add_joint(const std::string& name, const std::string& first, const std::string& second,
                             const Eigen::Vector3d& point, const When& when, const JointParts& parts);
  MultibodySystem& add_axis(const std::string& joint, bool is_hinge, const std::pair<Index, Index>& bodies,
                            const Eigen::Vector3d& point, const Eigen::Vector3d& axis);
  std::shared_ptr<const JointAxis> axis_of(const std::string& subject, const std::string& joint,
                                           JointKind kind) const;

  std::vector<std::string> names_;
  std::vector<Eigen::Isometry3d> placements_;
  std::vector<Touching> contacts_;
  std::vector<std::shared_ptr<const JointAxis>> axes_;
};

}  // namespace hybrid_sphere::mechanics
