#include "ground/ground.hpp"

#include <algorithm>
#include <limits>

namespace hybrid_sphere {
namespace {

/// The regions whose boxes hold a point, from the top one down.
class RegionsAt {
 public:
  RegionsAt(const RegionIndex& index, const Vector2d& point)
      : unbounded_(index.unbounded()), left_(unbounded_.size()) {
    index.query({point, point}, bounded_);
  }

  /// no_region when there is no further one.
  RegionId next() {
    const RegionId of_first = bounded_.empty() ? no_region : bounded_.back();
    const RegionId of_second = left_ == 0 ? no_region : unbounded_[left_ - 1];
    if (of_first > of_second) {
      bounded_.pop_back();
    } else if (of_second != no_region) {
      --left_;
    }
    return std::max(of_first, of_second);
  }

 private:
  std::vector<RegionId> bounded_;
  const std::vector<RegionId>& unbounded_;
  std::size_t left_;
};

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
  RegionsAt regions(index_, point);
  for (;;) {
    const RegionId id = regions.next();
    if (id == no_region) return base_region;
    if (locate(shape(id), point) != Side::outside) return id;
  }
}

std::vector<RegionId> Ground::edges_seen_at(const Vector2d& point) const {
  RegionsAt regions(index_, point);
  std::vector<RegionId> found;
  for (RegionId id = regions.next(); id != no_region; id = regions.next()) {
    const Side side = locate(shape(id), point);
    if (side == Side::inside) break;
    if (side == Side::edge) found.push_back(id);
  }
  return found;
}

std::size_t Ground::max_crossings() const {
  std::size_t sum = 0;
  for (const scene::Region& region : surface_.regions) sum += hybrid_sphere::max_crossings(region.shape);
  return sum;
}

}  // namespace hybrid_sphere
