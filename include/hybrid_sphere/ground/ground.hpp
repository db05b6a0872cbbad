#pragma once

#include <string_view>
#include <utility>

#include "hybrid_sphere/ground/crossing.hpp"

namespace hybrid_sphere {

/// A surface made ready for the question what lies where.
class Ground {
 public:
  explicit Ground(scene::Surface surface) : surface_(std::move(surface)) {}

  const scene::Surface& surface() const { return surface_; }
  RegionId size() const { return static_cast<RegionId>(surface_.regions.size()); }
  const scene::Shape& shape(RegionId id) const {
    return surface_.regions[static_cast<std::size_t>(id)].shape;
  }

  scene::Law law(RegionId id) const {
    return id == base_region ? surface_.base : surface_.regions[static_cast<std::size_t>(id)].law;
  }

  /// Valid as long as the ground.
  std::string_view name(RegionId id) const {
    return id == base_region ? std::string_view(scene::base_name)
                             : std::string_view(surface_.regions[static_cast<std::size_t>(id)].name);
  }

  /// The region on top at a point, edges included.
  RegionId top_region(const Vector2d& point) const;

  std::size_t max_crossings() const;

 private:
  scene::Surface surface_;
};

}  // namespace hybrid_sphere
