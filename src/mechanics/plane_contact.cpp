#include "mechanics/plane_contact.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace hybrid_sphere::mechanics {
namespace {

/// x / |x| and its rate.
struct Unit : MovingDirection {
  double length;

  Unit(const Eigen::Vector3d& x, const Eigen::Vector3d& rate_of_x) : MovingDirection(), length(x.norm()) {
    direction = x / length;
    rate = (rate_of_x - direction * direction.dot(rate_of_x)) / length;
  }
};

/// The relative velocity in a direction that belongs to neither body.
void fill_component(Index row, const MovingDirection& along, const RelativeVelocity& point, BodyRows& rows) {
  rows.value[row] = along.direction.dot(point.velocity);
  rows.gradient.row(row) << along.direction.transpose(), along.direction.transpose() * point.by_w,
      -along.direction.transpose(), along.direction.transpose() * point.by_second_w;
  rows.gamma[row] = -(along.direction.dot(point.acceleration) + along.rate.dot(point.velocity));
}

// A disk counts as flat if its axle is within this angle of the normal [rad]. The direction from the point of
// contact to the centre then has a relative round-off of 1e-9. The direction of a sphere's slip is undefined
// within the same angle of the normal to the axis that it is measured from.
constexpr double flat_angle = 1e-7;

/// The direction Slip::along.
Unit slip_direction(const ContactGeometry& geometry, const MovingDirection& normal, const BodyMotion& first,
                    const BodyMotion& second) {
  const Eigen::Vector3d& n = normal.direction;
  if (geometry.is_disk()) {
    const DirectionMotion axle(first, geometry.axle);
    return {axle.direction.cross(n), axle.rate.cross(n) + axle.direction.cross(normal.rate)};
  }
  const DirectionMotion axis(geometry.second_radius ? BodyMotion() : second, geometry.axis);
  const double upward = n.dot(axis.direction);
  const double upward_rate = n.dot(axis.rate) + normal.rate.dot(axis.direction);
  const Unit along(axis.direction - n * upward, axis.rate - n * upward_rate - normal.rate * upward);
  if (along.length < flat_angle) {
    throw Undefined(
        "direction of a slip",
        "the line of the centres of two spheres is along the axis that their slip is measured from");
  }
  return along;
}

/// The surface of the second body below the first one.
struct SurfaceMotion {
  MovingDirection normal;
  Eigen::Vector3d point;       // of the surface [m]
  Eigen::Vector3d point_rate;  // for the rate of q [m/s]

  SurfaceMotion(const ContactGeometry& geometry, const PointMotion& center, const BodyMotion& second) {
    const PointMotion fixed(second, geometry.point);
    point = fixed.place;
    point_rate = fixed.rate;
    if (!geometry.second_radius) {
      const DirectionMotion upward(second, geometry.normal);
      normal = {upward.direction, upward.rate};
      return;
    }
    const Unit apart(center.place - fixed.place, center.rate - fixed.rate);
    normal = apart;
    point += *geometry.second_radius * normal.direction;
    point_rate += *geometry.second_radius * normal.rate;
  }
};

/// From the point of contact to the centre, and the height of the centre where it touches.
struct Standing {
  MovingDirection up;
  double height;           // [m]
  double height_rate = 0;  // for the rate of q [m/s]

  Standing(const ContactGeometry& geometry, const MovingDirection& normal, const BodyMotion& first)
      : up(normal), height(geometry.radius) {
    if (!geometry.is_disk()) return;
    const DirectionMotion axle(first, geometry.axle);
    const Eigen::Vector3d& n = normal.direction;
    const double tilt = n.dot(axle.direction);
    const double tilt_rate = n.dot(axle.rate) + normal.rate.dot(axle.direction);
    // n - tilt times the axle as a double cross product: without cancellation near the flat disk.
    const Eigen::Vector3d level = n.cross(axle.direction);
    const Eigen::Vector3d level_rate = n.cross(axle.rate) + normal.rate.cross(axle.direction);
    const Unit rising(axle.direction.cross(level), axle.rate.cross(level) + axle.direction.cross(level_rate));
    if (rising.length < flat_angle) {
      throw Undefined("point of contact",
                      "a disk lies flat on the plane of its contact and has no point of contact there");
    }
    up = rising;
    height = geometry.radius * rising.length;
    height_rate = -geometry.radius * tilt * tilt_rate / rising.length;
  }
};

}  // namespace

void RelativeVelocity::subtract(const BodyMotion& second, const Eigen::Vector3d& place,
                                const Eigen::Vector3d& place_rate) {
  const Eigen::Vector3d arm = place - second.x;
  velocity -= second.x_rate + second.R_rate * (second.R.transpose() * arm);
  by_second_w = cross_matrix(arm) * second.R;
  acceleration -=
      (second.R_rate * second.w).cross(arm) + (second.R * second.w).cross(place_rate - second.x_rate);
}

ContactMotion::ContactMotion(const ContactGeometry& geometry, const BodyMotion& first,
                             const BodyMotion& second) {
  const PointMotion center(first, geometry.center);
  const SurfaceMotion surface(geometry, center, second);
  const Standing standing(geometry, surface.normal, first);
  normal = surface.normal;
  const Eigen::Vector3d& n = normal.direction;
  const Eigen::Vector3d above = center.place - surface.point;
  gap = n.dot(above) - standing.height;
  gap_rate = n.dot(center.rate - surface.point_rate) + normal.rate.dot(above) - standing.height_rate;
  const Eigen::Vector3d spin = first.R * first.w;
  const Eigen::Vector3d arm = -geometry.radius * standing.up.direction;  // from the centre
  const Eigen::Vector3d arm_rate = -geometry.radius * standing.up.rate;
  point.velocity = center.rate + spin.cross(arm);
  point.by_w = center.by_w - cross_matrix(arm) * first.R;
  point.acceleration = center.acceleration + (first.R_rate * first.w).cross(arm) + spin.cross(arm_rate);
  point.subtract(second, center.place + arm, center.rate + arm_rate);
  point.velocity += n * (gap_rate - n.dot(point.velocity));
}

void RollingConstraint::fill(const Bodies& bodies, BodyRows& rows) const {
  const RelativeVelocity point = ContactMotion(geometry_, bodies[0], bodies[1]).point;
  rows.value = point.velocity;
  rows.gradient << Eigen::Matrix3d::Identity(), point.by_w, -Eigen::Matrix3d::Identity(), point.by_second_w;
  rows.gamma = -point.acceleration;
}

void RollingConstraint::position(double /*t*/, const Vector& q, Vector& value) const {
  const Bodies bodies = places(q);
  const ContactMotion contact(geometry_, bodies[0], bodies[1]);
  value = contact.normal.direction * contact.gap;
  require_finite(value);
}

void GapConstraint::fill(const Bodies& bodies, BodyRows& rows) const {
  const ContactMotion contact(geometry_, bodies[0], bodies[1]);
  fill_component(0, contact.normal, contact.point, rows);
  rows.value[0] = contact.gap_rate;
}

void GapConstraint::position(double /*t*/, const Vector& q, Vector& value) const {
  const Bodies bodies = places(q);
  value.setConstant(1, ContactMotion(geometry_, bodies[0], bodies[1]).gap);
  require_finite(value);
}

double GapGuard::value(double /*t*/, const Vector& q) const {
  const double gap = ContactMotion(geometry_, BodyMotion::at(first_, q), BodyMotion::at(second_, q)).gap;
  if (!std::isfinite(gap)) throw NotFinite(label_);
  return -gap;
}

double GapGuard::rate(double /*t*/, const Vector& q, const Vector& q_rate) const {
  BodyMotion first = BodyMotion::at(first_, q);
  BodyMotion second = BodyMotion::at(second_, q);
  first.move(first_, q, q_rate);
  second.move(second_, q, q_rate);
  const double rate = ContactMotion(geometry_, first, second).gap_rate;
  if (!std::isfinite(rate)) throw NotFinite("derivative of " + label_);
  return -rate;
}

void SlipConstraint::fill(const Bodies& bodies, BodyRows& rows) const {
  const ContactMotion contact(geometry_, bodies[0], bodies[1]);
  const MovingDirection& n = contact.normal;
  const Unit along = slip_direction(geometry_, n, bodies[0], bodies[1]);
  const Unit across(n.direction.cross(along.direction),
                    n.direction.cross(along.rate) + n.rate.cross(along.direction));
  Index row = 0;
  for (const Slip slip : {Slip::along, Slip::across}) {
    if (slip_.value_or(slip) != slip) continue;
    fill_component(row++, slip == Slip::along ? along : across, contact.point, rows);
  }
}

void BladeConstraint::fill(const Bodies& bodies, BodyRows& rows) const {
  const PointMotion point(bodies[0], point_);
  const DirectionMotion heading(bodies[0], direction_);
  const DirectionMotion normal(bodies[1], normal_);
  const Unit left(normal.direction.cross(heading.direction),
                  normal.direction.cross(heading.rate) + normal.rate.cross(heading.direction));
  RelativeVelocity relative{point.rate, point.by_w, {}, point.acceleration};
  relative.subtract(bodies[1], point.place, point.rate);
  fill_component(0, left, relative, rows);
}

}  // namespace hybrid_sphere::mechanics
