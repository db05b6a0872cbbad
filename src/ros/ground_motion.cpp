#include "hybrid_sphere/ros/ground_motion.hpp"

#include <algorithm>
#include <cmath>

#include "hybrid_sphere/sphere/dynamics.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

constexpr double most_lookups = 20000;  // of a point in a region
constexpr double tip = 0.3;             // length of its strokes over that of the arrow

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
                                    const std::vector<Label>& labels) {
  if (!anything_moves(ground)) return {};
  std::vector<Sample> samples;
  double fastest = 0;
  const auto look_at = [&](const Vector2d& position) {
    const scene::Material& material = ground.material(ground.top_region(position));
    if (!moves(material)) return;
    samples.push_back({position, ground_velocity(material, position)});
    fastest = std::max(fastest, samples.back().velocity.norm());
  };
  const int side = static_cast<int>(std::clamp(std::sqrt(most_lookups / (1 + ground.size())), 8.0, 24.0));
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      look_at(view.center + view.half * Vector2d((2. * column + 1) / side - 1, (2. * row + 1) / side - 1));
    }
  }
  for (const Label& label : labels) {
    if (label.visible) look_at(label.position);
  }
  std::vector<Vector2d> lines;
  const double longest = 1.6 * view.half / side;
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
