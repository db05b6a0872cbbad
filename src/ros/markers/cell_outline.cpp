#include "ros/markers/cell_outline.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace hybrid_sphere::ros_interface {
namespace {

/// A side of a rectangle, along one axis.
struct CellSide {
  double line;  ///< coordinate across the axis
  double begin;
  double end;
  RegionId region;
  bool is_upper;  ///< the rectangle lies below the line
};

class Joined {
 public:
  explicit Joined(std::size_t regions) : leaders_(regions) { std::iota(leaders_.begin(), leaders_.end(), 0); }

  RegionId leader(RegionId region) {
    while (of(region) != region) region = of(region) = of(of(region));
    return region;
  }
  void join(RegionId a, RegionId b) {
    const auto [first, second] = std::minmax({leader(a), leader(b)});
    of(second) = first;
  }

 private:
  RegionId& of(RegionId region) { return leaders_[static_cast<std::size_t>(region)]; }

  std::vector<RegionId> leaders_;
};

/// All sides along an axis, by their lines and then along them.
std::vector<CellSide> sides_along(int axis, const scene::Surface& surface) {
  std::vector<CellSide> sides;
  sides.reserve(2 * surface.image_regions);
  for (std::size_t i = 0; i < surface.image_regions; ++i) {
    const Box box = box_around(surface.regions[i].shape);
    const auto region = static_cast<RegionId>(i);
    const int across = 1 - axis;
    sides.push_back({box.low[across], box.low[axis], box.high[axis], region, false});
    sides.push_back({box.high[across], box.low[axis], box.high[axis], region, true});
  }
  std::sort(sides.begin(), sides.end(), [](const CellSide& a, const CellSide& b) {
    return std::tie(a.line, a.begin) < std::tie(b.line, b.begin);
  });
  return sides;
}

using SideIterator = std::vector<CellSide>::const_iterator;

/// Joins what lies below and above one line. Rectangles do not overlap, so that neither do the sides of those
/// on one side of it: as they come, each has to do with the last one from the other side and with no earlier
/// one.
void join_across(SideIterator begin, SideIterator end, Joined& joined) {
  const CellSide* last[2] = {nullptr, nullptr};
  for (SideIterator side = begin; side != end; ++side) {
    const CellSide* other = last[side->is_upper ? 0 : 1];
    if (other != nullptr && other->end > side->begin) joined.join(other->region, side->region);
    const CellSide*& own = last[side->is_upper ? 1 : 0];
    own = &*side;
  }
}

/// The parts of one line that have cells on one side alone: between its ends by turns, where those that come
/// twice are none.
void add_edges(int axis, SideIterator begin, SideIterator end, std::vector<double>& ends,
               std::vector<Vector2d>& edges) {
  ends.clear();
  for (SideIterator side = begin; side != end; ++side) ends.insert(ends.end(), {side->begin, side->end});
  std::sort(ends.begin(), ends.end());
  std::size_t left = 0;
  for (const double each : ends) {
    if (left > 0 && ends[left - 1] == each) {
      --left;
    } else {
      ends[left++] = each;
    }
  }
  for (std::size_t i = 0; i < left; ++i) {
    Vector2d& point = edges.emplace_back();
    point[axis] = ends[i];
    point[1 - axis] = begin->line;
  }
}

}  // namespace

CellOutline cell_outline(const scene::Surface& surface) {
  CellOutline outline;
  Joined joined(surface.regions.size());
  std::vector<double> ends;
  for (const int axis : {0, 1}) {
    const std::vector<CellSide> sides = sides_along(axis, surface);
    for (SideIterator begin = sides.begin(); begin != sides.end();) {
      const SideIterator end =
          std::find_if(begin, sides.end(), [&](const CellSide& side) { return side.line != begin->line; });
      join_across(begin, end, joined);
      add_edges(axis, begin, end, ends, outline.edges);
      begin = end;
    }
  }
  outline.leaders.reserve(surface.regions.size());
  for (std::size_t i = 0; i < surface.regions.size(); ++i) {
    outline.leaders.push_back(joined.leader(static_cast<RegionId>(i)));
  }
  return outline;
}

}  // namespace hybrid_sphere::ros_interface
