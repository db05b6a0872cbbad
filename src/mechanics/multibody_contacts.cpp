// Contacts of a MultibodySystem: bodies on planes, and spheres on one another.
#include <algorithm>
#include <cmath>

#include "hybrid_sphere/mechanics/multibody_system.hpp"
#include "mechanics/check_body.hpp"
#include "mechanics/placement.hpp"
#include "mechanics/plane_contact.hpp"
#include "mechanics/sliding_friction.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::mechanics {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// The heading of a blade makes a larger angle with the normal of its plane [rad]: its direction along the
// plane then has a relative round-off of less than 1e-6.
constexpr double min_blade_angle = 1e-9;

// The axle of a disk makes a larger angle with the normal of its plane where it is placed [rad]: ten times
// the angle at which a motion ends because the disk lies flat.
constexpr double min_axle_angle = 1e-6;

/// The shape of the first body.
ContactGeometry geometry_of(const std::string& subject, const ContactShape& shape, const Isometry3d& first) {
  check_positive(subject, "radius", shape.radius);
  if (shape.center) check_finite(subject, "centre of the shape", *shape.center);
  ContactGeometry geometry{};
  geometry.center = shape.center ? point_on(first, *shape.center) : Vector3d::Zero();
  geometry.axle =
      shape.axle ? direction_on(first, checked_direction(subject, "axle", *shape.axle)) : Vector3d::Zero();
  geometry.radius = shape.radius;
  return geometry;
}

ContactGeometry geometry_on_plane(const std::string& subject, const ContactShape& shape,
                                  const Isometry3d& first, const Plane& plane, const Isometry3d& second) {
  ContactGeometry geometry = geometry_of(subject, shape, first);
  check_finite(subject, "point of the plane", plane.point);
  const Vector3d normal = checked_direction(subject, "normal of the plane", plane.normal);
  if (shape.axle && !(normal.cross(shape.axle->stableNormalized()).norm() > min_axle_angle)) {
    refuse_part(subject, "an axle along the normal of the plane (a disk that lies flat)",
                "one at an angle of more than 1e-6 rad to it");
  }
  constexpr double steep = 0.9;
  geometry.point = point_on(second, plane.point);
  geometry.normal = direction_on(second, normal);
  geometry.axis = direction_on(second, std::abs(normal.x()) > steep ? Vector3d::UnitY() : Vector3d::UnitX());
  return geometry;
}

void check_restitution(const std::string& subject, double restitution) {
  if (restitution >= 0 && restitution <= 1) return;
  refuse_part(subject, "restitution = " + text::shortest(restitution), "0 to 1");
}

}  // namespace

MultibodySystem& MultibodySystem::rolling(const std::string& name, const std::string& body,
                                          const ContactShape& shape, const When& when, const Plane& plane) {
  const std::string subject = subject_of(name);
  const Index first = index_of_body(subject, body);
  const Index second = pair_of(subject, body, plane.body).second;
  const ContactGeometry geometry =
      geometry_on_plane(subject, shape, placement(first), plane, placement(second));
  return add(name, std::make_shared<RollingConstraint>("constraint " + name, first, second, geometry), when,
             first);
}

MultibodySystem& MultibodySystem::blade(const std::string& name, const std::string& body,
                                        const Vector3d& point, const Vector3d& direction, const When& when,
                                        const Plane& plane) {
  const std::string subject = subject_of(name);
  const Index first = index_of_body(subject, body);
  const Index second = pair_of(subject, body, plane.body).second;
  check_finite(subject, "point", point);
  const Vector3d heading = checked_direction(subject, "direction", direction);
  const Vector3d normal = checked_direction(subject, "normal of the plane", plane.normal);
  if (!(normal.cross(heading).norm() > min_blade_angle)) {
    refuse_part(subject, "a direction along the normal of the plane", "one at an angle to it");
  }
  return add(name,
             std::make_shared<BladeConstraint>(
                 "constraint " + name, first, second, point_on(placement(first), point),
                 direction_on(placement(first), heading), direction_on(placement(second), normal)),
             when, first);
}

MultibodySystem& MultibodySystem::contact(const std::string& name, const std::string& body,
                                          const ContactShape& shape, double restitution, const Plane& plane) {
  const std::string subject = subject_of(name);
  const Index first = index_of_body(subject, body);
  const Index second = pair_of(subject, body, plane.body).second;
  check_restitution(subject, restitution);
  return add_contact(name, first, second, restitution,
                     geometry_on_plane(subject, shape, placement(first), plane, placement(second)));
}

MultibodySystem& MultibodySystem::contact(const std::string& name, const std::string& first,
                                          const ContactShape& sphere_of_first, const std::string& second,
                                          const ContactShape& sphere_of_second, double restitution) {
  const std::string subject = subject_of(name);
  const Index one = index_of_body(subject, first);
  const Index other = pair_of(subject, first, second).second;
  check_restitution(subject, restitution);
  if (sphere_of_first.axle || sphere_of_second.axle) refuse_part(subject, "a disk on a body", "two spheres");
  ContactGeometry geometry = geometry_of(subject, sphere_of_first, placement(one));
  const ContactGeometry beside = geometry_of(subject, sphere_of_second, placement(other));
  const Vector3d apart = placement(one) * geometry.center - placement(other) * beside.center;
  const Vector3d normal = checked_direction(subject, "distance of the centres", apart);
  Index axis = 2;
  for (const Index i : {1, 0}) {
    if (std::abs(normal[i]) < std::abs(normal[axis])) axis = i;
  }
  geometry.point = beside.center;
  geometry.axis = Vector3d::Unit(axis);
  geometry.second_radius = beside.radius;
  return add_contact(name, one, other, restitution, geometry);
}

MultibodySystem& MultibodySystem::add_contact(const std::string& name, Index first, Index second,
                                              double restitution, const ContactGeometry& geometry) {
  add(name, std::make_shared<GapConstraint>("constraint " + name, first, second, geometry), always(), first);
  constraints.back().schedule.guard =
      std::make_shared<GapGuard>("guard of constraint " + name, first, second, geometry);
  constraints.back().unilateral = Unilateral{restitution};
  contacts_.push_back({name, first, second, std::make_shared<ContactGeometry>(geometry)});
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
  law.contact = static_cast<std::size_t>(constraint - constraints.begin());
  add(name,
      std::make_shared<SlipConstraint>("constraint " + name, place->first, place->second, *place->geometry,
                                       direction),
      always(), place->first);
  constraints.back().friction = std::move(law);
  return *this;
}

}  // namespace hybrid_sphere::mechanics
