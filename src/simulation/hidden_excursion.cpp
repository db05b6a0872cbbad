#include "simulation/hidden_excursion.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <functional>
#include <utility>

#include "simulation/edge_line.hpp"

namespace hybrid_sphere {

Sector Sector::complement() const {
  Sector other = *this;
  for (Vector2d& normal : other.normals) normal = -normal;
  other.is_convex = !is_convex || normals.size() == 1;
  return other;
}

template <class IsInside>
bool Sector::is_inside(const IsInside& of_side) const {
  return is_convex ? std::all_of(normals.begin(), normals.end(), of_side)
                   : std::any_of(normals.begin(), normals.end(), of_side);
}

bool Sector::contains(const Vector2d& vector, double rounding) const {
  return is_inside([&](const Vector2d& normal) { return vector.dot(normal) > rounding; });
}

bool Sector::is_entered(const Vector2d& direction, const Vector2d& velocity) const {
  const double rounding = 0x1p-40 * direction.norm();
  return is_inside([&](const Vector2d& normal) {
    const double across = direction.dot(normal);
    return across > rounding || (across >= -rounding && velocity.dot(normal) > 0);
  });
}

namespace {

/// The sides of a polygon that a place is on, to within rounding.
std::vector<std::int32_t> sides_at(const scene::Polygon& polygon, const Vector2d& place, double rounding) {
  std::vector<std::int32_t> sides;
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(polygon.vertices.size()); ++i) {
    if (distance_to_side(polygon, i, place) <= rounding) sides.push_back(i);
  }
  return sides;
}

/// Empty where the place is not on a straight edge of the region.
std::optional<Sector> sector_at(const scene::Shape& shape, const Vector2d& place) {
  const double rounding = 4 * DBL_EPSILON * (place.norm() + size_of(shape));
  Sector sector;
  if (const auto* half_plane = std::get_if<scene::HalfPlane>(&shape)) {
    const Vector2d normal = stable_normalized(half_plane->normal);
    if (!(std::abs((place - half_plane->point).dot(normal)) <= rounding)) return std::nullopt;
    sector.normals = {normal};
    return sector;
  }
  const auto* polygon = std::get_if<scene::Polygon>(&shape);
  if (!polygon) return std::nullopt;
  const std::vector<std::int32_t> sides = sides_at(*polygon, place, rounding);
  if (sides.empty() || sides.size() > 2) return std::nullopt;
  const auto normal_of = [&](std::int32_t index) {
    const EdgePiece side{EdgePiece::Kind::line, index};
    return local_edge(shape, side, line_of(shape, side)->point)->normal;
  };
  if (sides.size() == 1) {
    sector.normals = {normal_of(sides.front())};
    return sector;
  }
  const auto last_side = static_cast<std::int32_t>(polygon->vertices.size()) - 1;
  const bool is_at_seam = sides.front() == 0 && sides.back() == last_side;
  if (!is_at_seam && sides.back() != sides.front() + 1) return std::nullopt;
  const std::int32_t after = is_at_seam ? 0 : sides.back();
  sector.normals = {normal_of(is_at_seam ? last_side : sides.front()), normal_of(after)};
  const Vector2d onwards = line_of(shape, {EdgePiece::Kind::line, after})->direction;
  sector.is_convex = onwards.dot(sector.normals.front()) >= 0;
  return sector;
}

/// When a point that moves away from a line is back; 0 if it moves against it, never if nothing pulls it
/// back.
/// @param speed     away from the line [m/s]
/// @param rounding  of it
double return_time(double speed, double rounding, double acceleration) {
  if (std::abs(speed) <= rounding) speed = 0;
  if (speed < 0 || (speed == 0 && acceleration < 0)) return 0;
  return acceleration < 0 ? -2 * speed / acceleration : never;
}

/// When a uniformly accelerated motion leaves a sector [s].
double exit_time(const Sector& sector, const Vector2d& velocity, const Vector2d& acceleration) {
  const double rounding = 4 * DBL_EPSILON * velocity.norm();
  double time = sector.is_convex ? never : 0;
  for (const Vector2d& normal : sector.normals) {
    const double back = return_time(velocity.dot(normal), rounding, acceleration.dot(normal));
    time = sector.is_convex ? std::min(time, back) : std::max(time, back);
  }
  return time;
}

/// The ground that a path comes to where it leaves one beneath which others have edges, too; no_region if
/// that is not decided by straight edges.
/// @param regions    that have edges there, from the top down
/// @param next       the ground elsewhere next to the place
/// @param direction  from the place
/// @param velocity   with which the path goes on
RegionId ground_below(const Ground& ground, const std::vector<RegionId>& regions, RegionId left,
                      RegionId next, const Vector2d& place, const Vector2d& direction,
                      const Vector2d& velocity) {
  for (const RegionId region : regions) {
    if (region >= left) continue;
    const std::optional<Sector> sector = sector_at(ground.shape(region), place);
    if (!sector) return no_region;
    if (sector->is_entered(direction, velocity)) return region;
  }
  const bool has_edge = std::find(regions.begin(), regions.end(), next) != regions.end();
  return has_edge ? no_region : next;
}

/// The regions that have an edge at a place, from the top down.
std::vector<RegionId> regions_at(const Ground& ground, const Contacts& contacts, const Vector2d& place) {
  std::vector<RegionId> regions = ground.edges_seen_at(place);
  for (const Contact& contact : contacts) regions.push_back(contact.region);
  std::sort(regions.begin(), regions.end(), std::greater<>());
  regions.erase(std::unique(regions.begin(), regions.end()), regions.end());
  return regions;
}

}  // namespace

std::optional<HiddenExcursion> hidden_excursion(const Ground& ground, const Contacts& contacts, RegionId left,
                                                RegionId next, const Segment::Start& state,
                                                const Vector2d& acceleration) {
  constexpr double same = 1 - 0x1p-40;  // time, over edges on one line
  const Vector2d& place = state.position;
  const Vector2d& velocity = state.twist.velocity;
  const std::vector<RegionId> regions = regions_at(ground, contacts, place);
  HiddenExcursion excursion{never, no_region, {}};
  double size = place.norm();
  for (const RegionId region : regions) {  // over the edge of one that lies on the ground, or of that itself
    if (region < left) break;
    std::optional<Sector> sector = sector_at(ground.shape(region), place);
    if (!sector) return std::nullopt;
    if (region != left) sector = sector->complement();
    size = std::max(size, place.norm() + size_of(ground.shape(region)));
    const double time = exit_time(*sector, velocity, acceleration);
    if (time < same * excursion.end) excursion = {time, region, std::move(*sector)};
  }
  if (!(excursion.end > 0 && excursion.end < never)) return std::nullopt;
  const double way = (velocity.norm() + 0.5 * acceleration.norm() * excursion.end) * excursion.end;
  if (!(way <= unseen * size)) return std::nullopt;
  if (excursion.next == left) {
    const Vector2d direction = velocity + 0.5 * excursion.end * acceleration;
    const Vector2d last = velocity + excursion.end * acceleration;
    excursion.next = ground_below(ground, regions, left, next, place, direction, last);
    if (excursion.next == no_region) return std::nullopt;
  }
  return excursion;
}

}  // namespace hybrid_sphere
