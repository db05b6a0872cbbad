#include "ros/view/followed_view.hpp"

#include <algorithm>
#include <cmath>

namespace hybrid_sphere::ros_interface {
namespace {

/// One coordinate of the point after the body has moved from `before` to `now`. From the inner edge on the
/// remaining offset to the outer edge decays exponentially with the way of the body.
double followed(double center, double before, double now, double inner, double outer) {
  const double direction = now < before ? -1 : 1;
  const double way = std::abs(now - before);
  const double offset = direction * (before - center);
  const double free_way = std::max(0.0, inner - offset);
  if (way <= free_way) return center;
  const double start = std::max(offset, inner);
  const double end = outer - (outer - start) * std::exp(-(way - free_way) / (outer - inner));
  return now - direction * end;
}

}  // namespace

FollowedView::FollowedView(double distance, const Eigen::Vector3d& center, const Eigen::Vector3d& body)
    : distance_(distance), body_(body) {
  const Eigen::Vector3d outer = distance * DeadZone::outer();
  center_ = center.cwiseMax(body - outer).cwiseMin(body + outer);
}

void FollowedView::follow(const Eigen::Vector3d& body) {
  const Eigen::Vector3d outer = distance_ * DeadZone::outer();
  const Eigen::Vector3d inner = distance_ * DeadZone::inner();
  const bool has_jumped = ((body - body_).cwiseAbs().array() > 2 * outer.array()).any();
  if (has_jumped) {
    center_ = body;
  } else {
    for (Eigen::Index i = 0; i < 3; ++i)
      center_[i] = followed(center_[i], body_[i], body[i], inner[i], outer[i]);
  }
  body_ = body;
}

}  // namespace hybrid_sphere::ros_interface
