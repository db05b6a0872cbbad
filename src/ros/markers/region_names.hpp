#pragma once

#include <string>
#include <vector>

#include "ground/ground.hpp"
#include "ros/markers/surface_outline.hpp"

namespace hybrid_sphere::ros_interface {

/// A name as it is written on the map.
struct RegionName {
  RegionId region;
  Vector2d middle;  ///< [m]
  double size;      ///< height of a letter [m]
  std::string text;

  /// Half its width and its height [m].
  Vector2d half() const;
};

/// The names and laws of the regions that have room for them, none over another: where two would meet, the
/// one with less room goes up or down, or is left out. Of many regions of one ground the roomiest stands for
/// all.
/// @param leaders  see find_labels
std::vector<RegionName> region_names(const Ground& ground, const ViewSquare& view,
                                     const std::vector<RegionId>& leaders = {});

}  // namespace hybrid_sphere::ros_interface
