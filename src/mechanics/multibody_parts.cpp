// Joints and contacts of a MultibodySystem.
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "hybrid_sphere/mechanics/multibody_system.hpp"
#include "mechanics/check_body.hpp"
#include "mechanics/joint_constraint.hpp"
#include "mechanics/plane_contact.hpp"
#include "mechanics/sliding_friction.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::mechanics {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

std::string subject_of(const std::string& constraint) { return "constraint \"" + constraint + "\""; }

Vector3d point_on(const Isometry3d& placement, const Vector3d& point) {
  return placement.linear().transpose() * (point - placement.translation());
}

Vector3d direction_on(const Isometry3d& placement, const Vector3d& direction) {
  return placement.linear().transpose() * direction;
}

/// Two unit vectors that make a right-handed frame with a direction, the direction first.
std::array<Vector3d, 2> across(const Vector3d& direction) {
  const Vector3d first = direction.unitOrthogonal();
  return {first, direction.cross(first)};
}

/// The points of a joint on its bodies. @param point  in the world
JointGeometry at_point(const Isometry3d& first, const Isometry3d& second, const Vector3d& point) {
  JointGeometry geometry;
  geometry.first_point = point_on(first, point);
  geometry.second_point = point_on(second, point);
  return geometry;
}

/// Keeps a direction in common. @param axis  in the world, of unit length
void align(const Isometry3d& first, const Isometry3d& second, const Vector3d& axis, JointGeometry& geometry) {
  const auto [b, c] = across(axis);
  geometry.right_angles.emplace_back(direction_on(first, axis), direction_on(second, c));
  geometry.right_angles.emplace_back(direction_on(first, axis), direction_on(second, -b));
}

/// Keeps the attitude in common.
void align(const Isometry3d& first, const Isometry3d& second, JointGeometry& geometry) {
  for (Index i = 0; i < 3; ++i) {
    const Vector3d of_first = Vector3d::Unit((i + 2) % 3);
    const Vector3d of_second = first.linear() * Vector3d::Unit((i + 1) % 3);
    geometry.right_angles.emplace_back(of_first, direction_on(second, of_second));
  }
}

// The heading of a blade makes a larger angle with the normal of its plane [rad]: its direction along the
// plane then has a relative round-off of less than 1e-6.
constexpr double min_blade_angle = 1e-9;

// The axle of a disk makes a larger angle with the normal of its plane where it is placed [rad]: ten times
// the angle at which a motion ends because the disk lies flat.
constexpr double min_axle_angle = 1e-6;

ContactGeometry geometry_of(const std::string& subject, const ContactShape& shape, const Plane& plane,
                            const Isometry3d& placement) {
  check_positive(subject, "radius", shape.radius);
  check_finite(subject, "point of the plane", plane.point);
  if (shape.center) check_finite(subject, "centre of the shape", *shape.center);
  ContactGeometry geometry;
  geometry.center = shape.center ? point_on(placement, *shape.center) : Vector3d::Zero();
  geometry.axle = shape.axle ? direction_on(placement, checked_direction(subject, "axle", *shape.axle))
                             : Vector3d::Zero();
  geometry.radius = shape.radius;
  geometry.point = plane.point;
  geometry.normal = checked_direction(subject, "normal of the plane", plane.normal);
  if (shape.axle && !(geometry.normal.cross(shape.axle->stableNormalized()).norm() > min_axle_angle)) {
    refuse_part(subject, "an axle along the normal of the plane (a disk that lies flat)",
                "one at an angle of more than 1e-6 rad to it");
  }
  return geometry;
}

}  // namespace

std::pair<Index, Index> MultibodySystem::pair_of(const std::string& subject, const std::string& first,
                                                 const std::string& second) const {
  const Index one = index_of(subject, first);
  const Index other = index_of(subject, second);
  if (one == other) refuse_part(subject, "\"" + first + "\" twice", "two bodies, or one and the world");
  return {one, other};
}

MultibodySystem& MultibodySystem::add(const std::string& name,
                                      std::shared_ptr<const ConstraintFunction> function, const When& when,
                                      Index guarded) {
  refuse_unseen_rotations(subject_of(name), *function);
  Constraint constraint{name, std::move(function), {}};
  constraint.schedule.begin = when.begin();
  constraint.schedule.end = when.end();
  if (std::shared_ptr<const Guard> guard = when.guard("guard of constraint " + name)) {
    constraint.schedule.guard = std::make_shared<BodyGuard>(guarded, std::move(guard));
  }
  constraints.push_back(std::move(constraint));
  return *this;
}

MultibodySystem& MultibodySystem::add_joint(const std::string& name, const std::string& first,
                                            const std::string& second, const Vector3d& point,
                                            const When& when, const JointParts& parts) {
  const std::string subject = subject_of(name);
  check_finite(subject, "point", point);
  const auto [one, other] = pair_of(subject, first, second);
  JointGeometry geometry = at_point(placement(one), placement(other), point);
  parts(placement(one), placement(other), geometry);
  return add(name, std::make_shared<JointConstraint>("constraint " + name, one, other, std::move(geometry)),
             when, one == world_body ? other : one);
}

MultibodySystem& MultibodySystem::ball(const std::string& name, const std::string& first,
                                       const std::string& second, const Vector3d& point, const When& when) {
  return add_joint(
      name, first, second, point, when,
      [](const Isometry3d&, const Isometry3d&, JointGeometry& joint) { joint.has_point = true; });
}

MultibodySystem& MultibodySystem::hinge(const std::string& name, const std::string& first,
                                        const std::string& second, const Vector3d& point,
                                        const Vector3d& axis, const When& when) {
  const Vector3d direction = checked_direction(subject_of(name), "axis", axis);
  add_joint(name, first, second, point, when,
            [&](const Isometry3d& one, const Isometry3d& other, JointGeometry& joint) {
              joint.has_point = true;
              align(one, other, direction, joint);
            });
  return add_axis(name, true, pair_of(subject_of(name), first, second), point, direction);
}

MultibodySystem& MultibodySystem::weld(const std::string& name, const std::string& first,
                                       const std::string& second, const Vector3d& point, const When& when) {
  return add_joint(name, first, second, point, when,
                   [](const Isometry3d& one, const Isometry3d& other, JointGeometry& joint) {
                     joint.has_point = true;
                     align(one, other, joint);
                   });
}

MultibodySystem& MultibodySystem::slider(const std::string& name, const std::string& first,
                                         const std::string& second, const Vector3d& point,
                                         const Vector3d& axis, const When& when) {
  const Vector3d direction = checked_direction(subject_of(name), "axis", axis);
  add_joint(name, first, second, point, when,
            [&](const Isometry3d& one, const Isometry3d& other, JointGeometry& joint) {
              const auto [b, c] = across(direction);
              joint.across = {direction_on(one, b), direction_on(one, c)};
              align(one, other, joint);
            });
  return add_axis(name, false, pair_of(subject_of(name), first, second), point, direction);
}

MultibodySystem& MultibodySystem::planar(const std::string& name, const std::string& first,
                                         const std::string& second, const Vector3d& point,
                                         const Vector3d& normal, const When& when) {
  const Vector3d direction = checked_direction(subject_of(name), "normal", normal);
  return add_joint(name, first, second, point, when,
                   [&](const Isometry3d& one, const Isometry3d& other, JointGeometry& joint) {
                     joint.across = {direction_on(one, direction)};
                     align(one, other, direction, joint);
                   });
}

MultibodySystem& MultibodySystem::rod(const std::string& name, const std::string& first,
                                      const std::string& second, const Vector3d& point_of_first,
                                      const Vector3d& point_of_second, const When& when) {
  const std::string subject = subject_of(name);
  check_finite(subject, "point", point_of_first);
  check_finite(subject, "point", point_of_second);
  const double length = (point_of_second - point_of_first).norm();
  check_positive(subject, "length", length);
  const auto [one, other] = pair_of(subject, first, second);
  return add(name,
             std::make_shared<RodConstraint>("constraint " + name, one, other,
                                             point_on(placement(one), point_of_first),
                                             point_on(placement(other), point_of_second), length),
             when, one == world_body ? other : one);
}

MultibodySystem& MultibodySystem::rolling(const std::string& name, const std::string& body,
                                          const ContactShape& shape, const When& when, const Plane& plane) {
  const std::string subject = subject_of(name);
  const Index index = index_of_body(subject, body);
  ContactGeometry geometry = geometry_of(subject, shape, plane, placement(index));
  return add(name, std::make_shared<RollingConstraint>("constraint " + name, index, std::move(geometry)),
             when, index);
}

MultibodySystem& MultibodySystem::blade(const std::string& name, const std::string& body,
                                        const Vector3d& point, const Vector3d& direction, const When& when,
                                        const Plane& plane) {
  const std::string subject = subject_of(name);
  const Index index = index_of_body(subject, body);
  check_finite(subject, "point", point);
  const Vector3d heading = checked_direction(subject, "direction", direction);
  const Vector3d normal = checked_direction(subject, "normal of the plane", plane.normal);
  if (!(normal.cross(heading).norm() > min_blade_angle)) {
    refuse_part(subject, "a direction along the normal of the plane", "one at an angle to it");
  }
  return add(name,
             std::make_shared<BladeConstraint>("constraint " + name, index, point_on(placement(index), point),
                                               direction_on(placement(index), heading), normal),
             when, index);
}

MultibodySystem& MultibodySystem::contact(const std::string& name, const std::string& body,
                                          const ContactShape& shape, double restitution, const Plane& plane) {
  const std::string subject = subject_of(name);
  const Index index = index_of_body(subject, body);
  if (!(restitution >= 0 && restitution <= 1)) {
    refuse_part(subject, "restitution = " + text::shortest(restitution), "0 to 1");
  }
  const ContactGeometry geometry = geometry_of(subject, shape, plane, placement(index));
  add(name, std::make_shared<GapConstraint>("constraint " + name, index, geometry), always(), index);
  constraints.back().schedule.guard =
      std::make_shared<GapGuard>("guard of constraint " + name, index, geometry);
  constraints.back().unilateral = Unilateral{restitution};
  contacts_.push_back({name, index, shape, plane});
  return *this;
}

MultibodySystem& MultibodySystem::friction(const std::string& name, const std::string& contact,
                                           double coefficient, std::optional<double> static_coefficient) {
  return add_friction(name, contact, std::nullopt, {coefficient, static_coefficient, {}, nullptr});
}

MultibodySystem& MultibodySystem::friction(const std::string& name, const std::string& contact,
                                           Slip direction, double coefficient,
                                           std::optional<double> static_coefficient) {
  return add_friction(name, contact, direction, {coefficient, static_coefficient, {}, nullptr});
}

MultibodySystem& MultibodySystem::add_friction(const std::string& name, const std::string& contact,
                                               std::optional<Slip> direction, Friction law) {
  const std::string subject = "friction \"" + name + "\"";
  check_coefficients(subject, law);
  const auto is_it = [&](const Touching& touching) { return touching.constraint == contact; };
  const auto place = std::find_if(contacts_.begin(), contacts_.end(), is_it);
  const auto is_named = [&](const Constraint& constraint) { return constraint.name == contact; };
  const auto constraint = std::find_if(constraints.begin(), constraints.end(), is_named);
  if (place == contacts_.end() || constraint == constraints.end()) {
    std::string known;
    for (const Touching& touching : contacts_) known += (known.empty() ? "" : ", ") + touching.constraint;
    refuse_part(subject, "contact = \"" + contact + "\"",
                known.empty() ? "none, as there is no contact" : known);
  }
  const auto index = static_cast<std::size_t>(constraint - constraints.begin());
  const Touching touching = *place;
  const ContactGeometry geometry =
      geometry_of(subject, touching.shape, touching.plane, placement(touching.body));
  add(name, std::make_shared<SlipConstraint>("constraint " + name, touching.body, geometry, direction),
      always(), touching.body);
  law.contact = index;
  constraints.back().friction = std::move(law);
  return *this;
}

}  // namespace hybrid_sphere::mechanics
