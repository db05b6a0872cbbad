#include "html/cell_raster.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

namespace hybrid_sphere::html {
namespace {

/// Centres of pixels in [low, high], as a range of indices.
struct Range {
  Range(double low, double high, double begin, double pixel, std::size_t count)
      : first(index(std::ceil((low - begin) / pixel - 0.5), count)),
        end(index(std::floor((high - begin) / pixel - 0.5) + 1, count)) {}

  std::size_t first;
  std::size_t end;

 private:
  static std::size_t index(double at, std::size_t count) {
    return static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(count)));
  }
};

/// Of a cell, which may be turned, relative to the drawing's origin.
struct Cell {
  Rectangle box;
  std::vector<Vector2d> corners;  ///< counter-clockwise; empty: those of the box

  bool contains(const Vector2d& point) const {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vector2d side = corners[(i + 1) % corners.size()] - corners[i];
      const Vector2d way = point - corners[i];
      if (side.x() * way.y() - side.y() * way.x() < 0) return false;
    }
    return true;
  }

  double shortest_side() const {
    double shortest = (box.high - box.low).minCoeff();
    for (std::size_t i = 0; i < corners.size(); ++i)
      shortest = std::min(shortest, (corners[(i + 1) % corners.size()] - corners[i]).norm());
    return shortest;
  }
};

Cell cell_of(const scene::Region& region, const Vector2d& origin) {
  Cell cell{box_of(region.shape).moved(-origin), {}};
  const std::vector<Vector2d>& corners = std::get<scene::Polygon>(region.shape).vertices;
  if (corners[0].y() == corners[1].y()) return cell;
  for (const Vector2d& corner : corners) cell.corners.push_back(corner - origin);
  return cell;
}

void paint(const Cell& turned, CellRaster& raster) {
  const Rectangle& cell = turned.box;
  const Vector2d size = raster.box.high - raster.box.low;
  const double width = size.x() / static_cast<double>(raster.columns);
  const double height = size.y() / static_cast<double>(raster.rows);
  const Range columns(cell.low.x(), cell.high.x(), raster.box.low.x(), width, raster.columns);
  const Range rows(cell.low.y(), cell.high.y(), raster.box.low.y(), height, raster.rows);
  for (std::size_t row = rows.first; row < rows.end; ++row) {
    for (std::size_t column = columns.first; column < columns.end; ++column) {
      const Vector2d pixel(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
      if (!turned.contains(raster.box.low + pixel.cwiseProduct(Vector2d(width, height)))) continue;
      const std::size_t bit = row * raster.columns + column;
      raster.bits[bit / 8] = static_cast<std::uint8_t>(raster.bits[bit / 8] | 0x80U >> bit % 8);
    }
  }
}

std::size_t pixels(double length, double pixel, std::size_t max_side) {
  return static_cast<std::size_t>(std::clamp(std::round(length / pixel), 1.0, static_cast<double>(max_side)));
}

}  // namespace

std::optional<CellRaster> raster_of_cells(const scene::Surface& surface, const Drawing& drawing,
                                          std::size_t max_side) {
  std::vector<Cell> cells;
  CellRaster raster;
  double smallest = HUGE_VAL;
  for (std::size_t i = 0; i < surface.image_regions; ++i) {
    const Cell cell = cell_of(surface.regions[i], drawing.origin);
    if (!cell.box.meets(drawing.inside)) continue;
    smallest = std::min(smallest, cell.shortest_side());
    if (cells.empty()) raster.box = cell.box;
    raster.box = {raster.box.low.cwiseMin(cell.box.low), raster.box.high.cwiseMax(cell.box.high)};
    cells.push_back(cell);
  }
  if (cells.empty()) return std::nullopt;
  const Vector2d size = raster.box.high - raster.box.low;
  raster.columns = pixels(size.x(), smallest, max_side);
  raster.rows = pixels(size.y(), smallest, max_side);
  raster.bits.resize((raster.columns * raster.rows + 7) / 8);
  for (const Cell& cell : cells) paint(cell, raster);
  return raster;
}

}  // namespace hybrid_sphere::html
