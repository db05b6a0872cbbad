#include "html/drawn_ground.hpp"

#include <algorithm>
#include <cmath>

namespace hybrid_sphere::html {
namespace {

constexpr std::size_t max_cells = 1500;       // drawn as regions; more are drawn as a picture
constexpr std::size_t bytes_of_region = 48;   // about, besides its corners
constexpr std::size_t bytes_of_corner = 11;   // two binary32 in base64
constexpr std::size_t max_path_points = 200;  // to which the distance of a region is taken

/// The squares that show the path, and the finite regions near it; relative to nothing.
DrawnGround frame(const scene::Surface& surface, const std::vector<Vector2d>& path, double radius) {
  Rectangle box{path.front(), path.front()};
  for (const Vector2d& point : path) box = {box.low.cwiseMin(point), box.high.cwiseMax(point)};
  const Vector2d middle = 0.5 * (box.low + box.high);
  const double half = std::max(0.5 * (box.high - box.low).maxCoeff(), 4 * radius);
  const Rectangle near = Rectangle{middle, middle}.grown(2 * half);
  for (const scene::Region& region : surface.regions) {
    const Rectangle around = box_of(region.shape);
    const bool is_near =
        (around.low.array() >= near.low.array()).all() && (around.high.array() <= near.high.array()).all();
    if (is_near) box = {box.low.cwiseMin(around.low), box.high.cwiseMax(around.high)};
  }
  DrawnGround ground;
  ground.drawing.origin = 0.5 * (box.low + box.high);
  ground.extent = (0.5 * (box.high - box.low).array() + 2 * radius).max(5 * radius);
  ground.view = ground.extent.maxCoeff();
  const Vector2d zero = Vector2d::Zero();
  ground.drawing.inside = Rectangle{zero, zero}.grown(4 * ground.view);
  ground.drawing.tolerance = std::min(2e-3 * ground.view, 0.05 * radius);
  ground.drawing.tolerance = std::max(ground.drawing.tolerance, 1e-5 * ground.view);
  return ground;
}

/// From a rectangle to the nearest of some points.
double distance(const Rectangle& box, const std::vector<Vector2d>& points) {
  double nearest = HUGE_VAL;
  for (const Vector2d& point : points) {
    const Vector2d beside = (box.low - point).cwiseMax(point - box.high).cwiseMax(0);
    nearest = std::min(nearest, beside.squaredNorm());
  }
  return nearest;
}

std::vector<Vector2d> some_of(const std::vector<Vector2d>& path) {
  std::vector<Vector2d> points;
  const std::size_t step = path.size() / max_path_points + 1;
  for (std::size_t i = 0; i < path.size(); i += step) points.push_back(path[i]);
  points.push_back(path.back());
  return points;
}

struct Candidate {
  std::size_t region;
  std::size_t bytes;
  double distance = 0;  // from the path, where that decides
};

/// Of those that together need more room the nearest to the path, in the order of the surface.
void choose(const scene::Surface& surface, const std::vector<Vector2d>& path, std::size_t room,
            std::vector<Candidate>& candidates) {
  std::size_t sum = 0;
  for (const Candidate& candidate : candidates) sum += candidate.bytes;
  if (sum <= room) return;
  const std::vector<Vector2d> points = some_of(path);
  for (Candidate& candidate : candidates) {
    candidate.distance = distance(box_of(surface.regions[candidate.region].shape), points);
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.region > b.region;
  });
  std::vector<Candidate> chosen;
  for (const Candidate& candidate : candidates) {
    if (candidate.bytes > room) continue;
    room -= candidate.bytes;
    chosen.push_back(candidate);
  }
  std::sort(chosen.begin(), chosen.end(),
            [](const Candidate& a, const Candidate& b) { return a.region < b.region; });
  candidates = std::move(chosen);
}

std::size_t bytes_of(const CellRaster& raster) { return raster.bits.size() * 4 / 3; }

}  // namespace

DrawnGround draw_ground(const scene::Surface& surface, const std::vector<Vector2d>& path, double radius,
                        std::size_t room) {
  DrawnGround ground = frame(surface, path, radius);
  const Rectangle inside = ground.drawing.inside.moved(ground.drawing.origin);
  std::vector<Candidate> candidates;
  std::size_t cells = 0;
  for (std::size_t i = 0; i < surface.regions.size(); ++i) {
    const scene::Shape& shape = surface.regions[i].shape;
    const bool is_met = box_of(shape).meets(inside);
    const auto* circle = std::get_if<scene::Circle>(&shape);
    const auto* polygon = std::get_if<scene::Polygon>(&shape);
    const bool outside = (circle != nullptr && circle->outside) || (polygon != nullptr && polygon->outside);
    ground.beyond += is_met || outside ? 0 : 1;
    if (!is_met && !outside) continue;
    cells += i < surface.image_regions ? 1 : 0;
    const std::size_t corners = corners_of(shape, ground.drawing);
    candidates.push_back({i, bytes_of_region + bytes_of_corner * corners});
  }
  if (cells > max_cells) {
    const auto max_side = static_cast<std::size_t>(std::sqrt(3.0 * static_cast<double>(room)));
    ground.cells = raster_of_cells(surface, ground.drawing, std::min<std::size_t>(max_side, 1024));
    candidates.erase(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(cells));
    if (ground.cells) room -= std::min(room, bytes_of(*ground.cells));
  }
  const std::size_t all = candidates.size();
  choose(surface, path, room, candidates);
  ground.left_out = all - candidates.size();
  for (const Candidate& candidate : candidates) {
    std::vector<Ring> rings = rings_of(surface.regions[candidate.region].shape, ground.drawing);
    if (!rings.empty()) ground.regions.push_back({candidate.region, std::move(rings)});
  }
  return ground;
}

}  // namespace hybrid_sphere::html
