#include "ground/box_tree.hpp"

#include <algorithm>
#include <utility>

namespace hybrid_sphere {
namespace {

/// Number of boxes that a box of the level above encloses.
constexpr std::size_t fan_out = 16;

using BoxIterator = std::vector<RegionBox>::iterator;

double middle_of(const RegionBox& box, int axis) {
  return box.bounds.low[axis] / 2 + box.bounds.high[axis] / 2;
}

void enclose(const Box& box, Box& enclosing) {
  for (int axis = 0; axis < 2; ++axis) {
    enclosing.low[axis] = std::min(enclosing.low[axis], box.low[axis]);
    enclosing.high[axis] = std::max(enclosing.high[axis], box.high[axis]);
  }
}

/// Sorts boxes so that those which share a box of the next level are neighbours: halves along the axis over
/// which the boxes are spread more widely.
void group(BoxIterator begin, BoxIterator end) {
  const auto size = static_cast<std::size_t>(end - begin);
  if (size <= fan_out) return;
  Box all = begin->bounds;
  for (BoxIterator box = begin; box != end; ++box) enclose(box->bounds, all);
  const int axis = all.high.x() - all.low.x() >= all.high.y() - all.low.y() ? 0 : 1;
  const std::size_t half = (size / 2 + fan_out - 1) / fan_out * fan_out;
  const BoxIterator middle = begin + static_cast<std::ptrdiff_t>(half);
  std::nth_element(begin, middle, end, [axis](const RegionBox& a, const RegionBox& b) {
    return middle_of(a, axis) < middle_of(b, axis);
  });
  group(begin, middle);
  group(middle, end);
}

const Box& bounds_of(const RegionBox& box) { return box.bounds; }
const Box& bounds_of(const Box& box) { return box; }

template <class Boxes>
std::vector<Box> enclosing_boxes(const Boxes& boxes) {
  std::vector<Box> enclosing;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (i % fan_out == 0) enclosing.push_back(bounds_of(boxes[i]));
    enclose(bounds_of(boxes[i]), enclosing.back());
  }
  return enclosing;
}

double squared_distance(const Vector2d& point, const Box& box) {
  double sum = 0;
  for (int axis = 0; axis < 2; ++axis) {
    const double below = box.low[axis] - point[axis];
    const double above = point[axis] - box.high[axis];
    const double distance = std::max({below, above, 0.0});
    sum += distance * distance;
  }
  return sum;
}

}  // namespace

BoxTree::BoxTree(std::vector<RegionBox> boxes) : boxes_(std::move(boxes)) {
  group(boxes_.begin(), boxes_.end());
  levels_.push_back(enclosing_boxes(boxes_));
  while (levels_.back().size() > fan_out) levels_.push_back(enclosing_boxes(levels_.back()));
}

void BoxTree::query(const Box& box, std::vector<RegionId>& regions) const {
  query(levels_.size(), 0, box, regions);
}

/// @param level  of the node; 0: `node` encloses boxes of regions
void BoxTree::query(std::size_t level, std::size_t node, const Box& box,
                    std::vector<RegionId>& regions) const {
  const std::size_t first = node * fan_out;
  if (level == 0) {
    const std::size_t end = std::min(first + fan_out, boxes_.size());
    for (std::size_t i = first; i < end; ++i) {
      if (meet(boxes_[i].bounds, box)) regions.push_back(boxes_[i].region);
    }
    return;
  }
  const std::vector<Box>& nodes = levels_[level - 1];
  const std::size_t end = std::min(first + fan_out, nodes.size());
  for (std::size_t i = first; i < end; ++i) {
    if (meet(nodes[i], box)) query(level - 1, i, box, regions);
  }
}

double BoxTree::reach(const Vector2d& point, std::size_t count) const {
  std::vector<double> nearest;
  find_nearest(levels_.size(), 0, point, count, nearest);
  return std::sqrt(nearest.front());
}

/// @param nearest  squared distances so far, a heap with the largest one in front
void BoxTree::find_nearest(std::size_t level, std::size_t node, const Vector2d& point, std::size_t count,
                           std::vector<double>& nearest) const {
  const std::size_t first = node * fan_out;
  const std::size_t size = level == 0 ? boxes_.size() : levels_[level - 1].size();
  const std::size_t end = std::min(first + fan_out, size);
  for (std::size_t i = first; i < end; ++i) {
    const Box& box = level == 0 ? boxes_[i].bounds : levels_[level - 1][i];
    const double distance = squared_distance(point, box);
    if (nearest.size() == count && distance >= nearest.front()) continue;
    if (level > 0) {
      find_nearest(level - 1, i, point, count, nearest);
      continue;
    }
    if (nearest.size() == count) {
      std::pop_heap(nearest.begin(), nearest.end());
      nearest.pop_back();
    }
    nearest.push_back(distance);
    std::push_heap(nearest.begin(), nearest.end());
  }
}

}  // namespace hybrid_sphere
