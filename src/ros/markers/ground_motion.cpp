#include "ros/markers/ground_motion.hpp"

#include <algorithm>
#include <cmath>
#include <set>

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

}  // namespace

std::vector<Vector2d> motion_arrows(const Ground& ground, const ViewSquare& view,
                                    const std::vector<RegionName>& names) {
  if (!anything_moves(ground)) return {};
  std::vector<Sample> samples;
  std::set<RegionId> seen;
  double fastest = 0;
  const auto look_at = [&](const Vector2d& position, RegionId ground_there) {
    const scene::Material& material = ground.material(ground_there);
    if (!moves(material)) return;
    samples.push_back({position, ground_velocity(material, position)});
    seen.insert(ground_there);
    fastest = std::max(fastest, std::hypot(samples.back().velocity.x(), samples.back().velocity.y()));
  };
  const int side =
      static_cast<int>(std::clamp(std::sqrt(max_arrow_lookups / (1 + ground.size())), 8.0, 24.0));
  const double longest = 1.6 * view.half / side;
  const auto is_written_over = [&](const Vector2d& position) {
    return std::any_of(names.begin(), names.end(), [&](const RegionName& name) {
      const Vector2d reach = name.half() + Vector2d::Constant(0.5 * longest);
      return ((position - name.middle).cwiseAbs().array() < reach.array()).all();
    });
  };
  const TopGrid grid(ground, view, side);
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const Vector2d position = grid.center(row, column);
      if (!is_written_over(position)) look_at(position, grid.top(row, column));
    }
  }
  for (const RegionName& name : names) {
    if (seen.count(name.region) > 0) continue;
    for (const double lines : {-1.5, 1.5, -3.0, 3.0}) {
      const Vector2d place =
          name.middle + Vector2d(0, lines * name.size + std::copysign(0.5 * longest, lines));
      if (ground.top_region(place) != name.region || is_written_over(place)) continue;
      look_at(place, name.region);
      break;
    }
  }
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

}  // namespace hybrid_sphere::ros_interface
