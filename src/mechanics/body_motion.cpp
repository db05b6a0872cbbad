#include "mechanics/body_motion.hpp"

#include <Eigen/Geometry>

namespace hybrid_sphere::mechanics {

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& r) {
  Eigen::Matrix3d result;
  result << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
  return result;
}

Eigen::Matrix3d rotation_of(const Eigen::Vector4d& quaternion) {
  const double w = quaternion[0], x = quaternion[1], y = quaternion[2], z = quaternion[3];
  const double twice = 2 / quaternion.squaredNorm();
  const double wx = twice * w * x, wy = twice * w * y, wz = twice * w * z;
  const double xx = twice * x * x, yy = twice * y * y, zz = twice * z * z;
  const double xy = twice * x * y, xz = twice * x * z, yz = twice * y * z;
  Eigen::Matrix3d R;
  R << 1 - (yy + zz), xy - wz, xz + wy, xy + wz, 1 - (xx + zz), yz - wx, xz - wy, yz + wx, 1 - (xx + yy);
  return R;
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
  const Eigen::Vector3d r = quaternion.tail<3>(), r_rate = change.tail<3>();
  const Eigen::Vector3d turning = quaternion[0] * r_rate - change[0] * r - r.cross(r_rate);
  R_rate = R * cross_matrix(2 / quaternion.squaredNorm() * turning);
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
