#include "ros/markers/ground_motion.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "ros/markers/surface_labels.hpp"
#include "ros/markers/top_grid.hpp"
#include "sphere/dynamics.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

constexpr double max_arrow_lookups = 20000;  // of a point in a region
constexpr double tip = 0.3;                  // length of its strokes over that of the arrow

bool moves(const scene::Material& material) {
  return !material.belt.isZero(0) || material.turntable_rate != 0;
}

bool anything_moves(const Ground& ground) {
  const auto& regions = ground.surface().regions;
  return moves(ground.surface().base) ||
         std::any_of(regions.begin(), regions.end(),
                     [](const scene::Region& region) { return moves(region.material); });
}

struct Sample {
  Vector2d position;  // [m]
  Vector2d velocity;  // of the ground [m/s]
};

/// A grid of square cells whose corners are multiples of their side.
struct ArrowGrid {
  ViewSquare square;
  int side;     // number of cells along a side of the square
  double cell;  // [m]
};

ArrowGrid grid_over(const ViewSquare& view, double unit, std::size_t regions) {
  const double lookups = max_arrow_lookups / (1 + static_cast<double>(regions));
  const int most = static_cast<int>(std::clamp(std::sqrt(lookups), 8.0, 96.0));
  double cell = unit / 12;
  while (2 * view.half > most * cell) cell *= 2;
  const int half = std::max(1, static_cast<int>(view.half / cell));
  const Vector2d center = (view.center / cell).array().round().matrix() * cell;
  return {{center, half * cell}, 2 * half, cell};
}

/// Looks for places of arrows, away from the names.
class ArrowPlaces {
 public:
  ArrowPlaces(const Ground& ground, const std::vector<RegionName>& names, double longest)
      : ground_(ground), names_(names), longest_(longest) {}

  void look_at(const Vector2d& position, RegionId ground_there) {
    const scene::Material& material = ground_.material(ground_there);
    if (!moves(material) || is_written_over(position)) return;
    samples_.push_back({position, ground_velocity(material, position)});
    seen_.insert(ground_there);
  }

  /// Looks near a point that is on a region without an arrow.
  void look_around(const Vector2d& middle, RegionId region) {
    if (!moves(ground_.material(region))) return;
    for (int ring = 0; ring <= 8 && seen_.count(region) == 0; ++ring) {
      for (const Vector2d& along : {Vector2d(0, -1), Vector2d(0, 1), Vector2d(1, 0), Vector2d(-1, 0)}) {
        const Vector2d place = middle + 0.5 * ring * longest_ * along;
        if (seen_.count(region) == 0 && ground_.top_region(place) == region) look_at(place, region);
      }
    }
  }

  bool has_seen(RegionId region) const { return seen_.count(region) > 0; }
  const std::vector<Sample>& samples() const { return samples_; }

 private:
  bool is_written_over(const Vector2d& position) const {
    return std::any_of(names_.begin(), names_.end(), [&](const RegionName& name) {
      const Vector2d reach = name.half() + Vector2d::Constant(0.5 * longest_);
      return ((position - name.middle).cwiseAbs().array() < reach.array()).all();
    });
  }

  const Ground& ground_;
  const std::vector<RegionName>& names_;
  double longest_;
  std::vector<Sample> samples_;
  std::set<RegionId> seen_;
};

std::vector<Vector2d> lines_of(const std::vector<Sample>& samples, double longest) {
  double fastest = 0;
  for (const Sample& sample : samples)
    fastest = std::max(fastest, std::hypot(sample.velocity.x(), sample.velocity.y()));
  std::vector<Vector2d> lines;
  for (const Sample& sample : samples) {
    if (sample.velocity.isZero(0)) continue;
    const Vector2d arrow = longest * (sample.velocity / fastest);
    const Vector2d end = sample.position + 0.5 * arrow;
    const Vector2d across = 0.5 * tip * turned(arrow);
    lines.insert(lines.end(),
                 {end - arrow, end, end - tip * arrow + across, end, end - tip * arrow - across, end});
  }
  return lines;
}

}  // namespace

std::vector<Vector2d> motion_arrows(const Ground& ground, const ViewSquare& view,
                                    const std::vector<RegionName>& names, double unit) {
  if (!anything_moves(ground)) return {};
  const ArrowGrid arrows = grid_over(view, unit > 0 ? unit : view.half, ground.surface().regions.size());
  const double longest = 0.8 * arrows.cell;
  ArrowPlaces places(ground, names, longest);
  const TopGrid grid(ground, arrows.square, arrows.side);
  for (int row = 0; row < arrows.side; ++row) {
    for (int column = 0; column < arrows.side; ++column)
      places.look_at(grid.center(row, column), grid.top(row, column));
  }
  for (const RegionName& name : names) {
    if (!places.has_seen(name.region)) places.look_around(name.middle, name.region);
  }
  constexpr std::size_t max_looked_for = 1000;  // regions, so that the time is bounded
  const auto& regions = ground.surface().regions;
  for (std::size_t i = 0; i < std::min(regions.size(), max_looked_for); ++i) {
    const auto region = static_cast<RegionId>(i);
    if (places.has_seen(region) || !moves(regions[i].material)) continue;
    const Vector2d middle = middle_of(regions[i].shape);
    if (view.contains(middle)) places.look_around(middle, region);
  }
  return lines_of(places.samples(), longest);
}

}  // namespace hybrid_sphere::ros_interface
