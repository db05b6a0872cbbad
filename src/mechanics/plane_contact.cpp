#include "mechanics/plane_contact.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace hybrid_sphere::mechanics {
namespace {

/// x / |x| and its rate. @param rate  of x
struct Unit {
  Eigen::Vector3d direction;
  Eigen::Vector3d rate;
  double length;

  Unit(const Eigen::Vector3d& x, const Eigen::Vector3d& x_rate) : length(x.norm()) {
    direction = x / length;
    rate = (x_rate - direction * direction.dot(x_rate)) / length;
  }
};

/// The velocity of a point in a direction that is not the body's.
void fill_component(Index row, const Unit& along, const Eigen::Vector3d& velocity,
                    const Eigen::Matrix3d& by_w, const Eigen::Vector3d& acceleration, BodyRows& rows) {
  rows.value[row] = along.direction.dot(velocity);
  rows.gradient.row(row).head<3>() = along.direction;
  rows.gradient.row(row).segment<3>(3) = along.direction.transpose() * by_w;
  rows.gamma[row] = -(along.direction.dot(acceleration) + along.rate.dot(velocity));
}

// A disk counts as flat if its axle is within this angle of the normal [rad]. The direction from the point of
// contact to the centre then has a relative round-off of 1e-9.
constexpr double flat_angle = 1e-7;

/// The direction Slip::along.
Unit rolling_direction(const ContactGeometry& geometry, const BodyMotion& body) {
  const Eigen::Vector3d& n = geometry.normal;
  if (geometry.is_disk()) {
    const DirectionMotion axle(body, geometry.axle);
    return {axle.direction.cross(n), axle.rate.cross(n)};
  }
  constexpr double steep = 0.9;
  const Eigen::Vector3d axis = std::abs(n.x()) > steep ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitX();
  return {axis - n * n.dot(axis), Eigen::Vector3d::Zero()};
}

}  // namespace

ContactMotion::ContactMotion(const ContactGeometry& geometry, const BodyMotion& body) {
  const PointMotion center(body, geometry.center);
  const Eigen::Vector3d& n = geometry.normal;
  Eigen::Vector3d up = n;  // from the point of contact to the centre
  Eigen::Vector3d up_rate = Eigen::Vector3d::Zero();
  double height = geometry.radius;  // of the centre where it touches
  double height_rate = 0;
  if (geometry.is_disk()) {
    const DirectionMotion axle(body, geometry.axle);
    const double tilt = n.dot(axle.direction);
    const double tilt_rate = n.dot(axle.rate);
    // n - tilt times the axle as a double cross product: without cancellation near the flat disk.
    const Eigen::Vector3d level = n.cross(axle.direction);
    const Unit rising(axle.direction.cross(level),
                      axle.rate.cross(level) + axle.direction.cross(n.cross(axle.rate)));
    if (rising.length < flat_angle) {
      throw Undefined("point of contact",
                      "a disk lies flat on the plane of its contact and has no point of contact there");
    }
    up = rising.direction;
    up_rate = rising.rate;
    height = geometry.radius * rising.length;
    height_rate = -geometry.radius * tilt * tilt_rate / rising.length;
  }
  gap = n.dot(center.place - geometry.point) - height;
  gap_rate = n.dot(center.rate) - height_rate;
  const Eigen::Vector3d spin = body.R * body.w;
  const Eigen::Vector3d turning = -geometry.radius * spin.cross(up);
  velocity = center.rate + turning;
  velocity += n * (gap_rate - n.dot(velocity));
  by_w = center.by_w + geometry.radius * cross_matrix(up) * body.R;
  acceleration =
      center.acceleration - geometry.radius * ((body.R_rate * body.w).cross(up) + spin.cross(up_rate));
}

void RollingConstraint::fill(const Bodies& bodies, BodyRows& rows) const {
  const ContactMotion contact(geometry_, bodies[0]);
  rows.value = contact.velocity;
  rows.gradient.leftCols<3>().setIdentity();
  rows.gradient.middleCols<3>(3) = contact.by_w;
  rows.gamma = -contact.acceleration;
}

void RollingConstraint::position(double /*t*/, const Vector& q, Vector& value) const {
  value = geometry_.normal * ContactMotion(geometry_, places(q)[0]).gap;
  require_finite(value);
}

void GapConstraint::fill(const Bodies& bodies, BodyRows& rows) const {
  const ContactMotion contact(geometry_, bodies[0]);
  const Eigen::Vector3d& n = geometry_.normal;
  rows.value[0] = contact.gap_rate;
  rows.gradient.row(0).head<3>() = n;
  rows.gradient.row(0).segment<3>(3) = n.transpose() * contact.by_w;
  rows.gamma[0] = -n.dot(contact.acceleration);
}

void GapConstraint::position(double /*t*/, const Vector& q, Vector& value) const {
  value.setConstant(1, ContactMotion(geometry_, places(q)[0]).gap);
  require_finite(value);
}

double GapGuard::value(double /*t*/, const Vector& q) const {
  const double gap = ContactMotion(geometry_, BodyMotion::at(body_, q)).gap;
  if (!std::isfinite(gap)) throw NotFinite(label_);
  return -gap;
}

double GapGuard::rate(double /*t*/, const Vector& q, const Vector& q_rate) const {
  BodyMotion body = BodyMotion::at(body_, q);
  body.move(body_, q, q_rate);
  const double rate = ContactMotion(geometry_, body).gap_rate;
  if (!std::isfinite(rate)) throw NotFinite("derivative of " + label_);
  return -rate;
}

void SlipConstraint::fill(const Bodies& bodies, BodyRows& rows) const {
  const ContactMotion contact(geometry_, bodies[0]);
  const Unit along = rolling_direction(geometry_, bodies[0]);
  const Eigen::Vector3d& n = geometry_.normal;
  const Unit across(n.cross(along.direction), n.cross(along.rate));
  Index row = 0;
  for (const Slip slip : {Slip::along, Slip::across}) {
    if (slip_.value_or(slip) != slip) continue;
    const Unit& direction = slip == Slip::along ? along : across;
    fill_component(row++, direction, contact.velocity, contact.by_w, contact.acceleration, rows);
  }
}

void BladeConstraint::fill(const Bodies& bodies, BodyRows& rows) const {
  const PointMotion point(bodies[0], point_);
  const DirectionMotion heading(bodies[0], direction_);
  const Unit left(normal_.cross(heading.direction), normal_.cross(heading.rate));
  fill_component(0, left, point.rate, point.by_w, point.acceleration, rows);
}

}  // namespace hybrid_sphere::mechanics
