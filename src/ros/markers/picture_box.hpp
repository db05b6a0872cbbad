#pragma once

#include <cmath>

#include "hybrid_sphere/scene/scene.hpp"
#include "ros/view/camera.hpp"

namespace hybrid_sphere::ros_interface {

/// A rectangle in the picture of the first view's camera, in metres at the depth of its middle.
struct PictureBox {
  Vector2d middle;  ///< to the right and up
  Vector2d half;    ///< half its width and its height
};

/// How a point appears in the picture, apart from perspective.
/// @param place   on the ground [m]
/// @param height  over it [m]
inline Vector2d in_picture(const Vector2d& place, double height) {
  return {place.x(), place.y() * std::sin(camera::pitch) + height * std::cos(camera::pitch)};
}

/// Whether two rectangles may overlap wherever they are in the picture.
inline bool may_overlap(const PictureBox& a, const PictureBox& b) {
  constexpr double far_ground =
      0.75;  // length of the ground in the upper half of the picture over that in the middle
  const Vector2d apart = (a.middle - b.middle).cwiseAbs();
  const Vector2d reach = a.half + b.half;
  return apart.x() < 1.05 * reach.x() && far_ground * apart.y() < reach.y();
}

/// Whether a segment may come into a rectangle. @param from, to  in the picture [m]
inline bool may_overlap(const PictureBox& box, const Vector2d& from, const Vector2d& to) {
  constexpr int points = 16;
  for (int i = 0; i <= points; ++i) {
    const double part = static_cast<double>(i) / points;
    if (may_overlap(box, PictureBox{from + part * (to - from), Vector2d::Zero()})) return true;
  }
  return false;
}

}  // namespace hybrid_sphere::ros_interface
