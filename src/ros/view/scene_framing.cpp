#include "ros/view/scene_framing.hpp"

#include <algorithm>
#include <cmath>

#include "ros/view/camera.hpp"
#include "ros/view/followed_view.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

constexpr double seconds_ahead = 6;
constexpr double margin = 1.1;

/// The greatest distance from which a body is wide enough wherever it is in the dead zone.
double greatest_distance(double half_width) {
  const double depth =
      1 + DeadZone::outer().y() * std::cos(camera::pitch) + DeadZone::outer().z() * std::sin(camera::pitch);
  const double pixels_at_depth = 0.5 * camera::picture_height / camera::half_height();  // of 1 m at 1 m
  return 2 * half_width * pixels_at_depth / (camera::least_body_width * depth);
}

/// The least distance from which a body in the dead zone is wholly in the picture.
double least_distance(double half_width) { return 25 * half_width; }

}  // namespace

Framing frame_box(const AlignedBox3d& box) {
  const Vector3d middle = 0.5 * box.min() + 0.5 * box.max();
  const Vector3d half = box.max() - middle;
  const double upward = half.y() * std::sin(camera::pitch) + half.z() * std::cos(camera::pitch);
  const double nearer = half.y() * std::cos(camera::pitch) + half.z() * std::sin(camera::pitch);
  const double away = std::max(half.x() / camera::least_aspect, upward) / camera::half_height();
  return {middle, margin * (away + nearer)};
}

Framing first_framing(const AlignedBox3d& map, const FramedBody& body) {
  AlignedBox3d box = map;
  const Vector3d reach = Vector3d(2, 2, 0) * body.half_width;
  for (const double time : {0.0, seconds_ahead}) {
    const Vector3d place = body.position + time * body.velocity;
    box.extend(AlignedBox3d(place - reach, place + reach));
  }
  Framing framing = frame_box(box);
  const Vector3d offset = (body.position - framing.center).cwiseAbs();
  const double for_body = offset.cwiseQuotient(DeadZone::outer()).maxCoeff();
  framing.distance = std::clamp(std::max(framing.distance, for_body), least_distance(body.half_width),
                                greatest_distance(body.half_width));
  framing.center = FollowedView(framing.distance, framing.center, body.position).center();
  return framing;
}

Framing whole_framing(const AlignedBox3d& map, const FramedBody& body, const Framing& first) {
  AlignedBox3d box = map;
  box.extend(body.position);
  box.extend(first.center);
  Framing framing = frame_box(box);
  framing.distance = std::max(framing.distance, first.distance);
  return framing;
}

}  // namespace hybrid_sphere::ros_interface
