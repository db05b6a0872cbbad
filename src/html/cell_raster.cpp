#include "html/cell_raster.hpp"

#include <algorithm>
#include <cmath>

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

void paint(const Rectangle& cell, CellRaster& raster) {
  const Vector2d size = raster.box.high - raster.box.low;
  const double width = size.x() / static_cast<double>(raster.columns);
  const double height = size.y() / static_cast<double>(raster.rows);
  const Range columns(cell.low.x(), cell.high.x(), raster.box.low.x(), width, raster.columns);
  const Range rows(cell.low.y(), cell.high.y(), raster.box.low.y(), height, raster.rows);
  for (std::size_t row = rows.first; row < rows.end; ++row) {
    for (std::size_t column = columns.first; column < columns.end; ++column) {
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
  std::vector<Rectangle> cells;
  CellRaster raster;
  double smallest = HUGE_VAL;
  for (std::size_t i = 0; i < surface.image_regions; ++i) {
    const Rectangle cell = box_of(surface.regions[i].shape).moved(-drawing.origin);
    if (!cell.meets(drawing.inside)) continue;
    smallest = std::min(smallest, (cell.high - cell.low).minCoeff());
    if (cells.empty()) raster.box = cell;
    raster.box = {raster.box.low.cwiseMin(cell.low), raster.box.high.cwiseMax(cell.high)};
    cells.push_back(cell);
  }
  if (cells.empty()) return std::nullopt;
  const Vector2d size = raster.box.high - raster.box.low;
  raster.columns = pixels(size.x(), smallest, max_side);
  raster.rows = pixels(size.y(), smallest, max_side);
  raster.bits.resize((raster.columns * raster.rows + 7) / 8);
  for (const Rectangle& cell : cells) paint(cell, raster);
  return raster;
}

}  // namespace hybrid_sphere::html
