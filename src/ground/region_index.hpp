#pragma once

#include <memory>
#include <vector>

#include "ground/box_tree.hpp"

namespace hybrid_sphere {

/// Finds the regions of a surface that may lie in a rectangle, without examining all of them: a tree of
/// the boxes around the bounded regions. It holds no reference to the surface, never changes, and its copies
/// share their data.
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
  std::vector<RegionId> unbounded_;
  std::vector<RegionBox> bounded_;       // only where there is no tree
  std::shared_ptr<const BoxTree> tree_;  // null where there are few bounded regions
  bool is_small_ = true;
  double spacing_;
};

/// The smallest box with binary64 coordinates around a bounded region; for a region with outside: true,
/// around the circle or polygon that it excludes.
/// @param shape  no HalfPlane
Box box_around(const scene::Shape& shape);

}  // namespace hybrid_sphere
