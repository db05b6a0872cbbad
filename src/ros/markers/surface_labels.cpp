#include "ros/markers/surface_labels.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "ros/markers/top_grid.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

constexpr double max_label_lookups = 60000;  // of a point in a region
constexpr std::size_t max_small_names = 1000;
constexpr double max_corners_looked_at = 1e7;  // for the small ones

/// The distance to other ground, at the centres of a square's cells, with a border of no ground around them.
class Raster {
 public:
  Raster(const Ground& ground, const ViewSquare& view, const std::vector<RegionId>& leaders)
      : grid_(ground, view,
              static_cast<int>(std::clamp(std::sqrt(max_label_lookups / (1 + ground.size())), 12.0, 80.0))),
        side_(grid_.side()),
        view_(view),
        top_(at(side_ + 2, 0), no_region),
        distance_(top_.size(), 0),
        run_(top_.size(), 0) {
    for (int row = 1; row <= side_; ++row) {
      for (int column = 1; column <= side_; ++column) {
        const RegionId top = grid_.top(row - 1, column - 1);
        top_[at(row, column)] =
            leaders.empty() || top == base_region ? top : leaders[static_cast<std::size_t>(top)];
      }
    }
    for (int row = 1; row <= side_; ++row) {
      for (int column = 1; column <= side_; ++column) sweep(row, column, -1);
    }
    for (int row = side_; row >= 1; --row) {
      for (int column = side_; column >= 1; --column) sweep(row, column, 1);
    }
    for (int row = 1; row <= side_; ++row) find_runs(row);
  }

  /// Calls with (region, place, distance to other ground, the same to the left and to the right) for every
  /// cell.
  template <class Visit>
  void for_each(const Visit& visit) const {
    const double cell = 2 * view_.half / side_;
    for (int row = 1; row <= side_; ++row) {
      for (int column = 1; column <= side_; ++column) {
        const std::size_t here = at(row, column);
        visit(top_[here], center(row, column), distance_[here] * cell, run_[here] * cell);
      }
    }
  }

 private:
  std::size_t at(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(side_ + 2) +
           static_cast<std::size_t>(column);
  }

  Vector2d center(int row, int column) const { return grid_.center(row - 1, column - 1); }

  /// One step of a distance transform: the distance in cells by way of the neighbours on one side.
  void sweep(int row, int column, int step) {
    const std::size_t here = at(row, column);
    double least = step < 0 ? HUGE_VAL : distance_[here];
    const auto by = [&](int neighbour_row, int neighbour_column, double length) {
      const std::size_t there = at(neighbour_row, neighbour_column);
      least = std::min(least, top_[there] == top_[here] ? distance_[there] + length : 0.5 * length);
    };
    by(row + step, column - 1, std::sqrt(2));
    by(row + step, column, 1);
    by(row + step, column + 1, std::sqrt(2));
    by(row, column + step, 1);
    distance_[here] = least;
  }

  void find_runs(int row) {
    const auto is_next = [&](int column, int step) {
      return top_[at(row, column)] == top_[at(row, column - step)];
    };
    for (int column = 1; column <= side_; ++column)
      run_[at(row, column)] = is_next(column, 1) ? run_[at(row, column - 1)] + 1 : 0.5;
    double to_right = 0;
    for (int column = side_; column >= 1; --column) {
      to_right = is_next(column, -1) ? to_right + 1 : 0.5;
      run_[at(row, column)] = std::min(run_[at(row, column)], to_right);
    }
  }

  TopGrid grid_;
  int side_;
  ViewSquare view_;
  std::vector<RegionId> top_;
  std::vector<double> distance_;
  std::vector<double> run_;
};

/// A point of the plane that stands for a shape too small for the raster.
struct Middle {
  Vector2d operator()(const scene::HalfPlane& half_plane) const { return half_plane.point; }
  Vector2d operator()(const scene::Circle& circle) const { return circle.center; }
  Vector2d operator()(const scene::Polygon& polygon) const {
    Vector2d sum = Vector2d::Zero();
    for (const Vector2d& vertex : polygon.vertices) sum += vertex;
    return sum / static_cast<double>(polygon.vertices.size());
  }
};

double corners_of(const Ground& ground) {
  double sum = 0;
  for (const scene::Region& region : ground.surface().regions) {
    const auto* polygon = std::get_if<scene::Polygon>(&region.shape);
    sum += polygon ? static_cast<double>(polygon->vertices.size()) : 1;
  }
  return sum;
}

}  // namespace

Vector2d middle_of(const scene::Shape& shape) { return std::visit(Middle{}, shape); }

std::vector<Label> find_labels(const Ground& ground, const ViewSquare& view,
                               const std::vector<RegionId>& leaders) {
  const std::size_t regions = ground.surface().regions.size();
  std::vector<Label> labels(regions + 1, Label{view.center, 0, false});
  const double enough = 0.2 * view.half;
  const Vector2d preferred =
      view.center + Vector2d(0, 0.3 * view.half);  // beside the way of a sphere from the middle
  std::vector<double> widths(regions + 1, 0);
  const auto look_at = [&](RegionId id, const Vector2d& position, double distance, double run) {
    const std::size_t i = id == base_region ? regions : static_cast<std::size_t>(id);
    Label& label = labels[i];
    const double room = std::min(distance, enough);
    const double width = std::min(run, 1.5 * enough);
    const double away = (label.position - preferred).norm() - (position - preferred).norm();
    if (std::tuple(room, width, away) > std::tuple(label.room, widths[i], 0.0)) {
      label = {position, room, true};
      widths[i] = width;
    }
  };
  Raster(ground, view, leaders).for_each(look_at);
  if (regions > max_small_names ||
      static_cast<double>(regions) * corners_of(ground) > max_corners_looked_at) {
    return labels;
  }
  for (std::size_t i = 0; i < regions; ++i) {
    if (!leaders.empty() && leaders[i] != static_cast<RegionId>(i)) continue;
    const Vector2d middle = middle_of(ground.surface().regions[i].shape);
    if (!labels[i].visible && ground.top_region(middle) == static_cast<RegionId>(i))
      labels[i] = {middle, 0, true};
  }
  return labels;
}

}  // namespace hybrid_sphere::ros_interface
