#pragma once

#include <memory>
#include <utility>
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

/// Finds the regions of a surface that may lie in a rectangle, without examining all of them: an R-tree
/// (Boost.Geometry) of the boxes around the bounded regions, packed once. It holds no reference to the
/// surface, never changes, and its copies share their data.
class RegionIndex {
 public:
  explicit RegionIndex(const scene::Surface& surface);

  /// Half-planes, and all regions with outside: true; ascending.
  const std::vector<RegionId>& unbounded() const { return unbounded_; }

  /// Appends the bounded regions whose boxes meet the given one: ascending, each once. Allocates only space
  /// in the list.
  void query(const Box& box, std::vector<RegionId>& regions) const;

  /// Length over which a path meets a few regions [m], > 0; infinite if there are only a few.
  double spacing() const { return spacing_; }

  /// Whether a straight path is best traced over all bounded regions at once.
  bool is_small() const { return is_small_; }

 private:
  struct Tree;

  std::vector<RegionId> unbounded_;
  std::vector<std::pair<Box, RegionId>> bounded_;  // only where there is no tree
  std::shared_ptr<const Tree> tree_;               // null where there are few bounded regions
  bool is_small_ = true;
  double spacing_;
};

/// The smallest box with binary64 coordinates around a bounded region; for a region with outside: true,
/// around the circle or polygon that it excludes.
/// @param shape  no HalfPlane
Box box_around(const scene::Shape& shape);

}  // namespace hybrid_sphere
