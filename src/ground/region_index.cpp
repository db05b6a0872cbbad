#include "ground/region_index.hpp"

// The R-tree includes a header of Boost's that announces its own end on every compilation.
#define BOOST_ALLOW_DEPRECATED_HEADERS

#include <algorithm>
#include <boost/geometry/core/cs.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/geometry/strategies/strategies.hpp>
#include <boost/iterator/function_output_iterator.hpp>
#include <cmath>
#include <limits>
#include <utility>

namespace hybrid_sphere {
namespace {

namespace bg = boost::geometry;
namespace bgi = boost::geometry::index;

using TreePoint = bg::model::point<double, 2, bg::cs::cartesian>;
using TreeBox = bg::model::box<TreePoint>;
using Entry = std::pair<TreeBox, RegionId>;
using EntryTree = bgi::rtree<Entry, bgi::quadratic<16>>;

/// Up to this number of regions, a list is faster than a tree.
constexpr std::size_t max_regions_without_tree = 32;
/// Up to this number of regions, all count as near.
constexpr std::size_t very_few = 4;
/// Regions at which the spacing is taken, evenly over the list.
constexpr std::size_t samples = 101;
/// Neighbours that a sample has within the spacing, itself included.
constexpr unsigned neighbours = 8;

constexpr double infinity = std::numeric_limits<double>::infinity();

TreePoint tree_point(const Vector2d& p) { return {p.x(), p.y()}; }
TreeBox tree_box(const Box& box) { return {tree_point(box.low), tree_point(box.high)}; }

Vector2d center_of(const TreeBox& box) {
  const TreePoint& low = box.min_corner();
  const TreePoint& high = box.max_corner();
  return {low.get<0>() / 2 + high.get<0>() / 2, low.get<1>() / 2 + high.get<1>() / 2};
}

double width_of(const TreeBox& box) {
  const TreePoint& low = box.min_corner();
  const TreePoint& high = box.max_corner();
  return std::min(high.get<0>() - low.get<0>(), high.get<1>() - low.get<1>());
}

/// Distance from the middle of a region to the last one of its nearest neighbours.
double reach_of(const EntryTree& tree, const TreeBox& box) {
  const TreePoint middle = tree_point(center_of(box));
  double reach = 0;
  const auto note = [&](const Entry& entry) { reach = std::max(reach, bg::distance(middle, entry.first)); };
  tree.query(bgi::nearest(middle, neighbours), boost::make_function_output_iterator(note));
  return reach;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Returns the distance within which regions have a few neighbours. It is their width if they lie over each
/// other. It is a median, which a few distant or huge regions do not change.
double spacing_of(const EntryTree& tree, const std::vector<Entry>& entries) {
  std::vector<double> reaches;
  std::vector<double> widths;
  const std::size_t count = std::min(samples, entries.size());
  for (std::size_t i = 0; i < count; ++i) {
    const TreeBox& box = entries[i * entries.size() / count].first;
    reaches.push_back(reach_of(tree, box));
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

struct RegionIndex::Tree {
  explicit Tree(const std::vector<Entry>& list) : entries(list) {}
  EntryTree entries;
};

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
  std::vector<Entry> entries;
  const auto size = static_cast<RegionId>(surface.regions.size());
  for (RegionId id = 0; id < size; ++id) {
    const scene::Shape& shape = surface.regions[static_cast<std::size_t>(id)].shape;
    if (is_bounded(shape)) {
      entries.emplace_back(tree_box(box_around(shape)), id);
    } else {
      unbounded_.push_back(id);
    }
  }
  is_small_ = entries.size() <= max_regions_without_tree;
  if (is_small_) {
    for (const Entry& entry : entries) {
      const TreePoint& low = entry.first.min_corner();
      const TreePoint& high = entry.first.max_corner();
      bounded_.push_back({{{low.get<0>(), low.get<1>()}, {high.get<0>(), high.get<1>()}}, entry.second});
    }
  }
  if (entries.size() <= very_few) return;
  auto tree = std::make_shared<const Tree>(entries);
  spacing_ = spacing_of(tree->entries, entries);
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
  const auto append = [&regions](const Entry& entry) { regions.push_back(entry.second); };
  tree_->entries.query(bgi::intersects(tree_box(box)), boost::make_function_output_iterator(append));
  std::sort(regions.begin() + static_cast<std::ptrdiff_t>(before), regions.end());
}

}  // namespace hybrid_sphere
