#pragma once

#include <vector>

#include "ros/markers/region_names.hpp"
#include "ros/markers/surface_outline.hpp"

namespace hybrid_sphere::ros_interface {

/// The part of the ground that the following camera shows, and the names written there.
struct Picture {
  /// The part in which names are whole, also in a narrow picture.
  ViewSquare square;
  /// The part in which names are whole in a wide picture: for regions that are not in the narrow one.
  ViewSquare wide_square;
  /// Half the side of a square that fills the picture [m]: letters and lines are measured in it.
  double unit;
  /// Names that stay where they are.
  std::vector<RegionName> names;
};

/// The distances on the ground that a camera of the first view (camera.hpp) shows, over the camera's
/// distance.
namespace picture_part {
constexpr double whole = 0.38;  ///< from the centre in each direction, in a picture of the least aspect
constexpr double whole_if_wide = 0.48;  ///< the same with an aspect of 1.5, from a point farther away
constexpr double farther = 0.12;
constexpr double unit = 0.85;
constexpr double seen = 1.1;  ///< beyond it nothing is seen, in a picture twice as wide as high
}  // namespace picture_part

inline Picture picture_around(const Vector2d& center, double distance) {
  const Vector2d wide_center = center + Vector2d(0, picture_part::farther * distance);
  return {{center, picture_part::whole * distance},
          {wide_center, picture_part::whole_if_wide * distance},
          picture_part::unit * distance,
          {}};
}

}  // namespace hybrid_sphere::ros_interface
