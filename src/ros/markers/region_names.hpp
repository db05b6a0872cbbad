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

/// Where names may be written, and of which regions.
struct NameSettings {
  double unit = 0;            ///< letters are measured in it [m]; 0: half the side of the square
  bool are_whole = false;     ///< a name that the edge of the square would cut is left out
  bool are_of_small = false;  ///< only regions whose extent is less than a unit in each direction
  ViewSquare seen{Vector2d::Zero(),
                  0};            ///< no name of a small region is put here, where the picture might cut it
  std::vector<RegionName> kept;  ///< written already: they stay
};

/// The names and laws of the regions that have room for them, none over another: where two would meet, the
/// one with less room goes up or down, or is left out. Of many regions of one ground the roomiest stands for
/// all.
/// @param view     where places are looked for
/// @param leaders  see find_labels
/// @return  the names that are kept, then the new ones
std::vector<RegionName> region_names(const Ground& ground, const ViewSquare& view,
                                     const std::vector<RegionId>& leaders = {},
                                     const NameSettings& settings = {});

}  // namespace hybrid_sphere::ros_interface
