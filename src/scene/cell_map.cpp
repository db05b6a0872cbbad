#include "scene/cell_map.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <unordered_set>

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

/// A number as it is written: digits 10^exponent.
struct Decimal {
  double digits;  // a whole number below 2^53
  int exponent;
};

/// The shortest decimal that is read as the number; empty where it has too many digits.
std::optional<Decimal> decimal_of(double number) {
  constexpr std::size_t most_digits = 12;
  std::array<char, 32> room{};
  const auto written =
      std::to_chars(room.data(), room.data() + room.size(), number, std::chars_format::scientific);
  const std::string text(room.data(), written.ptr);  // d.ddde-05
  const std::size_t mark = text.find('e');
  std::string digits = text.substr(0, mark);
  const std::size_t point = digits.find('.');
  const std::size_t fraction = point == std::string::npos ? 0 : digits.size() - point - 1;
  if (fraction > most_digits) return std::nullopt;
  if (point != std::string::npos) digits.erase(point, 1);
  return Decimal{std::stod(digits), std::stoi(text.substr(mark + 1)) - static_cast<int>(fraction)};
}

/// origin + i resolution of the numbers as they are written, correctly rounded: the line at -0.7 + 3 0.1 is
/// the number -0.4. Empty where that has too many digits.
std::optional<double> line_as_written(const Decimal& origin, const Decimal& resolution, std::size_t i) {
  constexpr int most = 15;  // powers of ten that are exact, as are their products with 8 digits
  const int exponent = std::min({origin.exponent, resolution.exponent, 0});
  if (std::max(origin.exponent, resolution.exponent) - exponent > most || -exponent > most)
    return std::nullopt;
  const auto whole = [&](const Decimal& number) {
    return number.digits * std::pow(10, number.exponent - exponent);
  };
  const double sum = whole(origin) + static_cast<double>(i) * whole(resolution);
  const double largest =
      std::max({std::abs(whole(origin)), static_cast<double>(i) * whole(resolution), std::abs(sum)});
  if (!(largest < 0x1p53)) return std::nullopt;
  return sum / std::pow(10, -exponent);
}

[[noreturn]] void refuse_resolution(double resolution, double coordinate, const std::string& path) {
  throw SceneError(path + ".resolution", Tree(resolution).describe(),
                   "more than the rounding error of the coordinates, such as " + Tree(coordinate).describe());
}

/// The coordinates of the lines between the cells, growing.
std::vector<double> grid_lines(double origin, double resolution, std::size_t cells, const std::string& path) {
  std::vector<double> lines(cells + 1);
  const std::optional<Decimal> first = decimal_of(origin);
  const std::optional<Decimal> step = decimal_of(resolution);
  const bool is_written = first && step && line_as_written(*first, *step, cells);
  for (std::size_t i = 0; i <= cells; ++i) {
    const double computed = origin + static_cast<double>(i) * resolution;
    lines[i] = is_written ? line_as_written(*first, *step, i).value_or(computed) : computed;
    if (i > 0 && lines[i] <= lines[i - 1]) refuse_resolution(resolution, lines[i], path);
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

/// Rounding would move a turned corner that lies on the side of a neighbour off that side. Such a side has a
/// corner of its own there, at the same coordinates.
class TurnedCells {
 public:
  TurnedCells(const CellMap& cells, const std::vector<Rectangle>& rectangles) : cells_(cells) {
    for (const Rectangle& r : rectangles) {
      for (const std::uint32_t x : {r.x0, r.x1}) {
        for (const std::uint32_t y : {r.y0, r.y1}) corners_.insert(key(x, y));
      }
    }
  }

  Polygon polygon(const Rectangle& r) const {
    Polygon polygon;
    const auto add = [&](std::uint32_t x, std::uint32_t y) { polygon.vertices.push_back(corner(x, y)); };
    const auto add_if_corner = [&](std::uint32_t x, std::uint32_t y) {
      if (corners_.count(key(x, y)) != 0) add(x, y);
    };
    add(r.x0, r.y0);
    for (std::uint32_t x = r.x0 + 1; x < r.x1; ++x) add_if_corner(x, r.y0);
    add(r.x1, r.y0);
    for (std::uint32_t y = r.y0 + 1; y < r.y1; ++y) add_if_corner(r.x1, y);
    add(r.x1, r.y1);
    for (std::uint32_t x = r.x1 - 1; x > r.x0; --x) add_if_corner(x, r.y1);
    add(r.x0, r.y1);
    for (std::uint32_t y = r.y1 - 1; y > r.y0; --y) add_if_corner(r.x0, y);
    return polygon;
  }

 private:
  static std::uint64_t key(std::uint32_t x, std::uint32_t y) { return std::uint64_t{y} << 32U | x; }

  Vector2d corner(std::uint32_t x, std::uint32_t y) const {
    const Vector2d way = cells_.resolution * Vector2d(x, y);
    const Vector2d& axis = cells_.axis;
    return Vector2d(axis.x() * way.x() - axis.y() * way.y(), axis.y() * way.x() + axis.x() * way.y()) +
           cells_.origin;
  }

  const CellMap& cells_;
  std::unordered_set<std::uint64_t> corners_;
};

/// Rectangles along the axes of the ground.
class UprightCells {
 public:
  UprightCells(const CellMap& cells, const std::string& path)
      : x_(grid_lines(cells.origin.x(), cells.resolution, cells.width, path)),
        y_(grid_lines(cells.origin.y(), cells.resolution, cells.height, path)) {}

  Polygon polygon(const Rectangle& r) const {
    Polygon polygon;
    polygon.vertices = {
        {x_[r.x0], y_[r.y0]}, {x_[r.x1], y_[r.y0]}, {x_[r.x1], y_[r.y1]}, {x_[r.x0], y_[r.y1]}};
    return polygon;
  }

 private:
  std::vector<double> x_;
  std::vector<double> y_;
};

/// No coordinate of a turned map exceeds those of its origin by more than all of its cells in a row.
void check_turned(const CellMap& cells, const std::string& path) {
  for (const double coordinate : cells.origin) {
    const double farthest =
        std::abs(coordinate) + static_cast<double>(cells.width + cells.height) * cells.resolution;
    read_number(farthest, path + " (the far corner)", coordinate_range);
    if (farthest - cells.resolution == farthest) refuse_resolution(cells.resolution, farthest, path);
  }
}

}  // namespace

std::vector<Region> regions_of(const CellMap& cells, const Material& material, const std::string& prefix,
                               const std::string& path) {
  check(cells, path);
  const bool is_turned = cells.axis != Vector2d::UnitX();
  if (is_turned) check_turned(cells, path);
  std::optional<UprightCells> upright;
  if (!is_turned) upright.emplace(cells, path);
  RectangleBuilder builder(path);
  for (std::size_t row = 0; row < cells.height; ++row) {
    builder.add_row(cells.belonging.data() + row * cells.width, cells.width, row);
  }
  std::optional<TurnedCells> turned;
  if (is_turned) turned.emplace(cells, builder.rectangles());
  std::vector<Region> regions;
  regions.reserve(builder.rectangles().size());
  for (const Rectangle& r : builder.rectangles()) {
    Polygon polygon = is_turned ? turned->polygon(r) : upright->polygon(r);
    regions.push_back({prefix + std::to_string(regions.size()), std::move(polygon), material});
  }
  return regions;
}

}  // namespace hybrid_sphere::scene
