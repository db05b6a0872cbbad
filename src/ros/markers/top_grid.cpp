#include "ros/markers/top_grid.hpp"

#include <algorithm>
#include <cmath>

#include "interrupt/interrupt.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

constexpr std::size_t max_corners_tested_per_cell =
    64;  // corners of a polygon that is looked at for each cell

}  // namespace

TopGrid::TopGrid(const Ground& ground, const ViewSquare& view, int side)
    : side_(side),
      view_(view),
      top_(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), base_region) {
  for (RegionId id = 0; id < ground.size(); ++id) {
    interruption_point();
    paint(id, ground.shape(id));
  }
}

/// The first row or column whose centres are not before a coordinate.
int TopGrid::first_after(double coordinate, double middle) const {
  const double cells = ((coordinate - middle) / view_.half + 1) * side_ / 2 - 0.5;
  return static_cast<int>(std::clamp(std::ceil(cells), 0.0, static_cast<double>(side_)));
}

void TopGrid::paint(RegionId id, const scene::Shape& shape) {
  const auto* polygon = std::get_if<scene::Polygon>(&shape);
  if (polygon && polygon->vertices.size() > max_corners_tested_per_cell) return paint_polygon(id, *polygon);
  const auto* circle = std::get_if<scene::Circle>(&shape);
  const bool bounded = (polygon && !polygon->outside) || (circle && !circle->outside);
  if (!bounded) return paint_box(id, shape, {0, side_}, {0, side_});
  const Box box = box_around(shape);
  const auto cells = [&](int axis) {
    // One more on either side: the box is rounded.
    const int begin = first_after(box.low[axis], view_.center[axis]) - 1;
    const int end = first_after(box.high[axis], view_.center[axis]) + 1;
    return Range{std::max(begin, 0), std::min(end, side_)};
  };
  paint_box(id, shape, cells(1), cells(0));
}

void TopGrid::paint_box(RegionId id, const scene::Shape& shape, const Range& rows, const Range& columns) {
  for (int row = rows.begin; row < rows.end; ++row) {
    for (int column = columns.begin; column < columns.end; ++column) {
      if (locate(shape, center(row, column)) != Side::outside) top_[at(row, column)] = id;
    }
  }
}

/// By the even-odd rule, along each row.
void TopGrid::paint_polygon(RegionId id, const scene::Polygon& polygon) {
  odd_.assign(top_.size(), 0);
  const auto& vertices = polygon.vertices;
  for (std::size_t i = 0, j = vertices.size() - 1; i < vertices.size(); j = i++) {
    interruption_point();
    const Vector2d& a = vertices[j];
    const Vector2d& b = vertices[i];
    const int begin = first_after(std::min(a.y(), b.y()), view_.center.y());
    const int end = first_after(std::max(a.y(), b.y()), view_.center.y());
    for (int row = begin; row < end; ++row) {
      const double part = (y(row) - a.y()) / (b.y() - a.y());
      const int column = first_after(a.x() + std::clamp(part, 0.0, 1.0) * (b.x() - a.x()), view_.center.x());
      if (column < side_) odd_[at(row, column)] ^= 1;
    }
  }
  for (int row = 0; row < side_; ++row) {
    bool inside = polygon.outside;
    for (int column = 0; column < side_; ++column) {
      inside = inside != (odd_[at(row, column)] != 0);
      if (inside) top_[at(row, column)] = id;
    }
  }
}

}  // namespace hybrid_sphere::ros_interface
