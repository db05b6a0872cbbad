#pragma once

#include <vector>

#include "ground/ground.hpp"
#include "ros/markers/surface_outline.hpp"

namespace hybrid_sphere::ros_interface {

/// Which ground is on top at the centres of the cells of a square, for drawing: within rounding of an edge it
/// may be either. The time is that of one look at each corner for each row of cells, not for each cell.
class TopGrid {
 public:
  /// @param side  number of cells along a side of the square
  TopGrid(const Ground& ground, const ViewSquare& view, int side);

  int side() const { return side_; }
  /// @param row, column  0 to side - 1, from the lower left
  Vector2d center(int row, int column) const { return {x(column), y(row)}; }
  RegionId top(int row, int column) const { return top_[at(row, column)]; }

 private:
  struct Range {
    int begin;
    int end;
  };

  std::size_t at(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(side_) + static_cast<std::size_t>(column);
  }
  double x(int column) const { return view_.center.x() + view_.half * ((2. * column + 1) / side_ - 1); }
  double y(int row) const { return view_.center.y() + view_.half * ((2. * row + 1) / side_ - 1); }
  int first_after(double coordinate, double middle) const;

  void paint(RegionId id, const scene::Shape& shape);
  void paint_box(RegionId id, const scene::Shape& shape, const Range& rows, const Range& columns);
  void paint_polygon(RegionId id, const scene::Polygon& polygon);

  int side_;
  ViewSquare view_;
  std::vector<RegionId> top_;
  std::vector<char> odd_;  // by cell, whether an odd number of sides begins there
};

}  // namespace hybrid_sphere::ros_interface
