#include "mechanics/joint_axis.hpp"

#include <cmath>

namespace hybrid_sphere::mechanics {

JointAxis::Bodies JointAxis::at(const Vector& q, const Vector& v) const {
  Bodies result{BodyMotion::at(bodies[0], q, v), BodyMotion::at(bodies[1], q, v)};
  for (BodyMotion& body : result) body.move();
  return result;
}

JointAxis::Bodies JointAxis::moving(const Vector& q, const Vector& rate) const {
  Bodies result = at(q);
  for (std::size_t i = 0; i < result.size(); ++i) result[i].move(bodies[i], q, rate);
  return result;
}

// The angle of the vector (x, y) that the reference has on b and c, two directions of the first body.
AxisMotion JointAxis::angle(const Bodies& moving) const {
  const DirectionMotion b(moving[0], across);
  const DirectionMotion c(moving[0], axis.cross(across));
  const DirectionMotion d(moving[1], reference);
  const double x = b.direction.dot(d.direction);
  const double y = c.direction.dot(d.direction);
  const double x_rate = b.rate.dot(d.direction) + b.direction.dot(d.rate);
  const double y_rate = c.rate.dot(d.direction) + c.direction.dot(d.rate);
  const auto change = [&](const DirectionMotion& e) {
    return e.acceleration.dot(d.direction) + 2 * e.rate.dot(d.rate) + e.direction.dot(d.acceleration);
  };
  const double squared = x * x + y * y;
  AxisMotion motion;
  motion.value = std::atan2(y, x);
  if (motion.value <= -M_PI) motion.value = M_PI;
  motion.rate = (x * y_rate - y * x_rate) / squared;
  motion.gradient.setZero();
  motion.gradient.segment<3>(3) =
      (x * d.direction.transpose() * c.by_w - y * d.direction.transpose() * b.by_w) / squared;
  motion.gradient.segment<3>(9) = (x * c.direction - y * b.direction).transpose() * d.by_w / squared;
  motion.acceleration =
      (x * change(c) - y * change(b) - 2 * motion.rate * (x * x_rate + y * y_rate)) / squared;
  return motion;
}

AxisMotion JointAxis::displacement(const Bodies& moving) const {
  const PointMotion first(moving[0], first_point);
  const PointMotion second(moving[1], second_point);
  const DirectionMotion a(moving[0], axis);
  const Eigen::Vector3d apart = second.place - first.place;
  const Eigen::Vector3d rate = second.rate - first.rate;
  AxisMotion motion;
  motion.value = a.direction.dot(apart);
  motion.rate = a.direction.dot(rate) + a.rate.dot(apart);
  motion.gradient.segment<3>(0) = -a.direction;
  motion.gradient.segment<3>(3) = apart.transpose() * a.by_w - a.direction.transpose() * first.by_w;
  motion.gradient.segment<3>(6) = a.direction;
  motion.gradient.segment<3>(9) = a.direction.transpose() * second.by_w;
  motion.acceleration = a.direction.dot(second.acceleration - first.acceleration) + 2 * a.rate.dot(rate) +
                        a.acceleration.dot(apart);
  return motion;
}

Wrench DriveInteraction::wrench(double t, const Bodies& bodies) const {
  const AxisMotion motion = axis_->motion(bodies);
  const Eigen::Vector3d drive = function_(t, motion.value, motion.rate) * (bodies[0].R * axis_->axis);
  if (axis_->is_hinge) return {Eigen::Vector3d::Zero(), drive};
  return {drive, (bodies[1].R * axis_->second_point).cross(drive)};
}

}  // namespace hybrid_sphere::mechanics
