#include "hybrid_sphere/ground/ground.hpp"

namespace hybrid_sphere {

RegionId Ground::top_region(const Vector2d& point) const {
  for (RegionId id = size() - 1; id >= 0; --id) {
    if (locate(shape(id), point) != Side::outside) return id;
  }
  return base_region;
}

std::size_t Ground::max_crossings() const {
  std::size_t sum = 0;
  for (const scene::Region& region : surface_.regions) sum += hybrid_sphere::max_crossings(region.shape);
  return sum;
}

}  // namespace hybrid_sphere
