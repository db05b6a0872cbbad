#include "scene/cell_map.hpp"

namespace hybrid_sphere::scene {
namespace {

/// Cells [x0, x1) x [y0, y1).
struct Rectangle {
  std::uint32_t x0, x1, y0, y1;  // below max_cells; a large map has very many
};

/// Joins the runs of a row to the rectangles that the row below ended with.
class RectangleBuilder {
 public:
  explicit RectangleBuilder(const std::string& path) : path_(path) {}

  /// @param row  of the cells, the rows one after the other from the lowest
  void add_row(const std::uint8_t* row, std::size_t width, std::size_t y) {
    std::vector<std::size_t> open;
    std::size_t below = 0;  // the next of open_, which has the order of x
    for (std::size_t x = 0; x < width; ++x) {
      if (row[x] == 0) continue;
      const std::size_t x0 = x;
      while (x < width && row[x] != 0) ++x;
      while (below < open_.size() && rectangles_[open_[below]].x0 < x0) ++below;
      if (below < open_.size() && rectangles_[open_[below]].x0 == x0 && rectangles_[open_[below]].x1 == x) {
        open.push_back(open_[below]);
        rectangles_[open.back()].y1 = static_cast<std::uint32_t>(y + 1);
      } else {
        open.push_back(rectangles_.size());
        const auto cell = [](std::size_t i) { return static_cast<std::uint32_t>(i); };
        add({cell(x0), cell(x), cell(y), cell(y + 1)});
      }
    }
    open_ = std::move(open);
  }

  const std::vector<Rectangle>& rectangles() const { return rectangles_; }

 private:
  void add(const Rectangle& rectangle) {
    if (rectangles_.size() == max_cell_regions) {
      throw SceneError(path_, "a map of more than " + std::to_string(max_cell_regions) + " rectangles",
                       "up to " + std::to_string(max_cell_regions) + " after merging cells");
    }
    rectangles_.push_back(rectangle);
  }

  const std::string& path_;
  std::vector<Rectangle> rectangles_;
  std::vector<std::size_t> open_;  // those that reach up to the next row
};

/// The coordinates of the lines between the cells, growing.
std::vector<double> grid_lines(double origin, double resolution, std::size_t cells, const std::string& path) {
  std::vector<double> lines(cells + 1);
  for (std::size_t i = 0; i <= cells; ++i) {
    lines[i] = origin + static_cast<double>(i) * resolution;
    if (i > 0 && lines[i] <= lines[i - 1]) {
      throw SceneError(
          path + ".resolution", Tree(resolution).describe(),
          "more than the rounding error of the coordinates, such as " + Tree(lines[i]).describe());
    }
  }
  read_number(lines.back(), path + " (the far corner)", coordinate_range);
  return lines;
}

void check(const CellMap& cells, const std::string& path) {
  if (cells.width == 0 || cells.height == 0 || cells.width > max_cells / cells.height) {
    throw SceneError(
        path, "a map of " + std::to_string(cells.width) + " x " + std::to_string(cells.height) + " cells",
        "at least 1 x 1, up to " + std::to_string(max_cells) + " cells");
  }
  if (cells.belonging.size() != cells.width * cells.height) {
    throw SceneError(path, "a map with the values of " + std::to_string(cells.belonging.size()) + " cells",
                     std::to_string(cells.width * cells.height) + ", width times height");
  }
  read_number(cells.resolution, path + ".resolution", resolution_range);
  for (const double coordinate : cells.origin) read_number(coordinate, path + ".origin", coordinate_range);
}

}  // namespace

std::vector<Region> regions_of(const CellMap& cells, const Material& material, const std::string& prefix,
                               const std::string& path) {
  check(cells, path);
  const std::vector<double> x = grid_lines(cells.origin.x(), cells.resolution, cells.width, path);
  const std::vector<double> y = grid_lines(cells.origin.y(), cells.resolution, cells.height, path);
  RectangleBuilder builder(path);
  for (std::size_t row = 0; row < cells.height; ++row) {
    builder.add_row(cells.belonging.data() + row * cells.width, cells.width, row);
  }
  std::vector<Region> regions;
  regions.reserve(builder.rectangles().size());
  for (const Rectangle& r : builder.rectangles()) {
    Polygon polygon;
    polygon.vertices = {{x[r.x0], y[r.y0]}, {x[r.x1], y[r.y0]}, {x[r.x1], y[r.y1]}, {x[r.x0], y[r.y1]}};
    regions.push_back({prefix + std::to_string(regions.size()), std::move(polygon), material});
  }
  return regions;
}

}  // namespace hybrid_sphere::scene
