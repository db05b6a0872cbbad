#include "mechanics/joint_constraint.hpp"

namespace hybrid_sphere::mechanics {
namespace {

/// The difference of two points, second less first, in the world: its velocity by v1, w1, v2, w2.
Eigen::Matrix<double, 3, 12> gradient_of_difference(const PointMotion& first, const PointMotion& second) {
  Eigen::Matrix<double, 3, 12> gradient;
  gradient << -Eigen::Matrix3d::Identity(), -first.by_w, Eigen::Matrix3d::Identity(), second.by_w;
  return gradient;
}

}  // namespace

void JointConstraint::fill(const Bodies& bodies, BodyRows& rows) const {
  const PointMotion first(bodies[0], geometry_.first_point);
  const PointMotion second(bodies[1], geometry_.second_point);
  const Eigen::Vector3d apart = second.place - first.place;
  const Eigen::Vector3d rate = second.rate - first.rate;
  const Eigen::Vector3d acceleration = second.acceleration - first.acceleration;
  const Eigen::Matrix<double, 3, 12> difference = gradient_of_difference(first, second);
  Index row = 0;
  if (geometry_.has_point) {
    rows.value.head<3>() = rate;
    rows.gradient.topRows<3>() = difference;
    rows.gamma.head<3>() = -acceleration;
    row = 3;
  }
  for (const Eigen::Vector3d& across : geometry_.across) {
    const DirectionMotion d(bodies[0], across);
    rows.value[row] = d.direction.dot(rate) + d.rate.dot(apart);
    rows.gradient.row(row) = d.direction.transpose() * difference;
    rows.gradient.row(row).segment<3>(3) += apart.transpose() * d.by_w;
    rows.gamma[row] = -(2 * d.rate.dot(rate) + d.direction.dot(acceleration) + d.acceleration.dot(apart));
    ++row;
  }
  for (const auto& [of_first, of_second] : geometry_.right_angles) {
    const DirectionMotion a(bodies[0], of_first);
    const DirectionMotion b(bodies[1], of_second);
    rows.value[row] = a.rate.dot(b.direction) + a.direction.dot(b.rate);
    rows.gradient.row(row).segment<3>(3) = of_first.cross(bodies[0].R.transpose() * b.direction);
    rows.gradient.row(row).segment<3>(9) = of_second.cross(bodies[1].R.transpose() * a.direction);
    rows.gamma[row] =
        -(a.acceleration.dot(b.direction) + 2 * a.rate.dot(b.rate) + a.direction.dot(b.acceleration));
    ++row;
  }
}

void JointConstraint::position(double /*t*/, const Vector& q, Vector& value) const {
  const Bodies bodies = places(q);
  value.setZero(size());
  const Eigen::Vector3d apart =
      bodies[1].x + bodies[1].R * geometry_.second_point - bodies[0].x - bodies[0].R * geometry_.first_point;
  Index row = 0;
  if (geometry_.has_point) {
    value.head<3>() = apart;
    row = 3;
  }
  for (const Eigen::Vector3d& across : geometry_.across) value[row++] = (bodies[0].R * across).dot(apart);
  for (const auto& [a, b] : geometry_.right_angles) {
    value[row++] = (bodies[0].R * a).dot(bodies[1].R * b);
  }
  require_finite(value);
}

void RodConstraint::fill(const Bodies& bodies, BodyRows& rows) const {
  const PointMotion first(bodies[0], first_point_);
  const PointMotion second(bodies[1], second_point_);
  const Eigen::Vector3d apart = second.place - first.place;
  const Eigen::Vector3d rate = second.rate - first.rate;
  const double length = apart.norm();
  const Eigen::Vector3d along = apart / length;
  const Eigen::Vector3d along_rate = (rate - along * along.dot(rate)) / length;
  rows.value[0] = along.dot(rate);
  rows.gradient.row(0) = along.transpose() * gradient_of_difference(first, second);
  rows.gamma[0] = -(along_rate.dot(rate) + along.dot(second.acceleration - first.acceleration));
}

void RodConstraint::position(double /*t*/, const Vector& q, Vector& value) const {
  const Bodies bodies = places(q);
  const Eigen::Vector3d apart =
      bodies[1].x + bodies[1].R * second_point_ - bodies[0].x - bodies[0].R * first_point_;
  value.setConstant(1, apart.norm() - length_);
  require_finite(value);
}

}  // namespace hybrid_sphere::mechanics
