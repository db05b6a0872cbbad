#include "ground/region_index.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace hybrid_sphere {
namespace {

/// Up to this number of regions, a list is faster than a tree.
constexpr std::size_t max_regions_without_tree = 32;
/// Up to this number of regions, all count as near.
constexpr std::size_t very_few = 4;
/// Regions at which the spacing is taken, evenly over the list.
constexpr std::size_t samples = 101;
/// Neighbours that a sample has within the spacing, itself included.
constexpr std::size_t neighbours = 8;

constexpr double infinity = std::numeric_limits<double>::infinity();

Vector2d center_of(const Box& box) {
  return {box.low.x() / 2 + box.high.x() / 2, box.low.y() / 2 + box.high.y() / 2};
}

double width_of(const Box& box) { return std::min(box.high.x() - box.low.x(), box.high.y() - box.low.y()); }

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Returns the distance within which regions have a few neighbours. It is their width if they lie over each
/// other. It is a median, which a few distant or huge regions do not change.
double spacing_of(const BoxTree& tree, const std::vector<RegionBox>& boxes) {
  std::vector<double> reaches;
  std::vector<double> widths;
  const std::size_t count = std::min(samples, boxes.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Box& box = boxes[i * boxes.size() / count].bounds;
    reaches.push_back(tree.reach(center_of(box), neighbours));
    widths.push_back(width_of(box));
  }
  return std::max(median(std::move(reaches)), median(std::move(widths)));
}

bool is_bounded(const scene::Shape& shape) {
  if (const auto* circle = std::get_if<scene::Circle>(&shape)) return !circle->outside;
  if (const auto* polygon = std::get_if<scene::Polygon>(&shape)) return !polygon->outside;
  return false;
}

/// One step outwards is more than the rounding of the sum.
Box box_around_circle(const scene::Circle& circle) {
  const auto below = [&](double c) { return std::nextafter(c - circle.radius, -infinity); };
  const auto above = [&](double c) { return std::nextafter(c + circle.radius, infinity); };
  const Vector2d& c = circle.center;
  return {{below(c.x()), below(c.y())}, {above(c.x()), above(c.y())}};
}

}  // namespace

Box box_around(const scene::Shape& shape) {
  if (const auto* circle = std::get_if<scene::Circle>(&shape)) return box_around_circle(*circle);
  const std::vector<Vector2d>& vertices = std::get<scene::Polygon>(shape).vertices;
  Box box{vertices.front(), vertices.front()};
  for (const Vector2d& vertex : vertices) {
    box.low = box.low.cwiseMin(vertex);
    box.high = box.high.cwiseMax(vertex);
  }
  return box;
}

RegionIndex::RegionIndex(const scene::Surface& surface) : spacing_(infinity) {
  std::vector<RegionBox> boxes;
  const auto size = static_cast<RegionId>(surface.regions.size());
  for (RegionId id = 0; id < size; ++id) {
    const scene::Shape& shape = surface.regions[static_cast<std::size_t>(id)].shape;
    if (is_bounded(shape)) {
      boxes.push_back({box_around(shape), id});
    } else {
      unbounded_.push_back(id);
    }
  }
  is_small_ = boxes.size() <= max_regions_without_tree;
  if (is_small_) bounded_ = boxes;
  if (boxes.size() <= very_few) return;
  auto tree = std::make_shared<const BoxTree>(boxes);
  spacing_ = spacing_of(*tree, boxes);
  if (!is_small_) tree_ = std::move(tree);
}

void RegionIndex::query(const Box& box, std::vector<RegionId>& regions) const {
  if (!tree_) {
    for (const auto& [bounds, region] : bounded_) {
      if (meet(bounds, box)) regions.push_back(region);
    }
    return;
  }
  const std::size_t before = regions.size();
  tree_->query(box, regions);
  std::sort(regions.begin() + static_cast<std::ptrdiff_t>(before), regions.end());
}

}  // namespace hybrid_sphere
