// Joints of a MultibodySystem.
#include <array>

#include "hybrid_sphere/mechanics/multibody_system.hpp"
#include "mechanics/check_body.hpp"
#include "mechanics/joint_constraint.hpp"
#include "mechanics/placement.hpp"
#include "mechanics/plane_contact.hpp"

namespace hybrid_sphere::mechanics {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

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

}  // namespace hybrid_sphere::mechanics
