#include "hybrid_sphere/ground/ground.hpp"

#include <algorithm>
#include <limits>

namespace hybrid_sphere {
namespace {

/// The largest number that two ascending lists have left, taken from its list; no_region when they are used
/// up.
RegionId take_last(std::vector<RegionId>& first, std::size_t& left_in_second,
                   const std::vector<RegionId>& second) {
  const RegionId of_first = first.empty() ? no_region : first.back();
  const RegionId of_second = left_in_second == 0 ? no_region : second[left_in_second - 1];
  if (of_first > of_second) {
    first.pop_back();
  } else if (of_second != no_region) {
    --left_in_second;
  }
  return std::max(of_first, of_second);
}

Box extent_of(const scene::Surface& surface) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Box extent{Vector2d::Constant(infinity), Vector2d::Constant(-infinity)};
  for (const scene::Region& region : surface.regions) {
    const auto* half_plane = std::get_if<scene::HalfPlane>(&region.shape);
    const Box box = half_plane ? Box{half_plane->point, half_plane->point} : box_around(region.shape);
    extent.low = extent.low.cwiseMin(box.low);
    extent.high = extent.high.cwiseMax(box.high);
  }
  return extent;
}

}  // namespace

Ground::Ground(scene::Surface surface)
    : surface_(std::move(surface)), index_(surface_), extent_(extent_of(surface_)) {}

RegionId Ground::top_region(const Vector2d& point) const {
  std::vector<RegionId> bounded;
  index_.query({point, point}, bounded);
  std::size_t unbounded = index_.unbounded().size();
  for (;;) {
    const RegionId id = take_last(bounded, unbounded, index_.unbounded());
    if (id == no_region) return base_region;
    if (locate(shape(id), point) != Side::outside) return id;
  }
}

std::size_t Ground::max_crossings() const {
  std::size_t sum = 0;
  for (const scene::Region& region : surface_.regions) sum += hybrid_sphere::max_crossings(region.shape);
  return sum;
}

}  // namespace hybrid_sphere
