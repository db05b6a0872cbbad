#pragma once

#include <cstddef>
#include <vector>

#include "ground/crossing.hpp"

namespace hybrid_sphere {

/// A closed rectangle with sides along the axes [m]. low <= high in both coordinates; infinite ones are
/// allowed.
struct Box {
  Vector2d low;
  Vector2d high;
};

/// Whether two rectangles have a point in common.
inline bool meet(const Box& a, const Box& b) {
  return a.low.x() <= b.high.x() && b.low.x() <= a.high.x() && a.low.y() <= b.high.y() &&
         b.low.y() <= a.high.y();
}

/// The box of a bounded region.
struct RegionBox {
  Box bounds;
  RegionId region;
};

/// An R-tree of the boxes of regions, packed once: neighbours are next to each other in one list, and each
/// box of a level encloses a fixed number of boxes of the level below.
class BoxTree {
 public:
  /// @param boxes  at least one, finite
  explicit BoxTree(std::vector<RegionBox> boxes);

  /// Appends the regions whose boxes meet the given one, in any order.
  void query(const Box& box, std::vector<RegionId>& regions) const;

  /// Returns the distance from a point to the last one of its nearest boxes [m].
  /// @param count  how many of them there are; all boxes if these are fewer
  double reach(const Vector2d& point, std::size_t count) const;

 private:
  void query(std::size_t level, std::size_t node, const Box& box, std::vector<RegionId>& regions) const;
  void find_nearest(std::size_t level, std::size_t node, const Vector2d& point, std::size_t count,
                    std::vector<double>& nearest) const;

  std::vector<RegionBox> boxes_;
  std::vector<std::vector<Box>> levels_;  // the first encloses boxes_
};

}  // namespace hybrid_sphere
