#include "mechanics/body_motion.hpp"

#include <Eigen/Geometry>

namespace hybrid_sphere::mechanics {
namespace {

/// The symmetric bilinear form of the quaternion's matrix: of (a, a) it is R times the square of its length.
Eigen::Matrix3d bilinear(const Eigen::Vector4d& a, const Eigen::Vector4d& b) {
  const Eigen::Vector3d r = a.tail<3>(), s = b.tail<3>();
  Eigen::Matrix3d result = r * s.transpose() + s * r.transpose();
  result.diagonal().array() += a[0] * b[0] - r.dot(s);
  result += cross_matrix(a[0] * s + b[0] * r);
  return result;
}

}  // namespace

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& r) {
  Eigen::Matrix3d result;
  result << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
  return result;
}

Eigen::Matrix3d rotation_of(const Eigen::Vector4d& quaternion) {
  return bilinear(quaternion, quaternion) / quaternion.squaredNorm();
}

BodyMotion BodyMotion::at(Index body, const Vector& q) {
  BodyMotion motion;
  if (body == world_body) return motion;
  motion.x = q.segment<3>(body_coordinates * body);
  motion.R = rotation_of(q.segment<4>(body_coordinates * body + 3));
  return motion;
}

BodyMotion BodyMotion::at(Index body, const Vector& q, const Vector& v) {
  BodyMotion motion = at(body, q);
  if (body == world_body) return motion;
  motion.v = v.segment<3>(body_velocities * body);
  motion.w = v.segment<3>(body_velocities * body + 3);
  return motion;
}

void BodyMotion::move() {
  x_rate = v;
  R_rate = R * cross_matrix(w);
}

void BodyMotion::move(Index body, const Vector& q, const Vector& rate) {
  if (body == world_body) return;
  const Eigen::Vector4d quaternion = q.segment<4>(body_coordinates * body + 3);
  const Eigen::Vector4d change = rate.segment<4>(body_coordinates * body + 3);
  x_rate = rate.segment<3>(body_coordinates * body);
  R_rate = 2 * (bilinear(quaternion, change) - quaternion.dot(change) * R) / quaternion.squaredNorm();
}

PointMotion::PointMotion(const BodyMotion& body, const Eigen::Vector3d& r)
    : place(body.x + body.R * r),
      rate(body.x_rate + body.R_rate * r),
      by_w(-body.R * cross_matrix(r)),
      acceleration(body.R_rate * body.w.cross(r)) {}

DirectionMotion::DirectionMotion(const BodyMotion& body, const Eigen::Vector3d& d)
    : direction(body.R * d),
      rate(body.R_rate * d),
      by_w(-body.R * cross_matrix(d)),
      acceleration(body.R_rate * body.w.cross(d)) {}

}  // namespace hybrid_sphere::mechanics
