#pragma once

#include <string_view>
#include <utility>

#include "ground/crossing.hpp"
#include "ground/region_index.hpp"

namespace hybrid_sphere {

/// A surface prepared for queries of what lies where.
class Ground {
 public:
  explicit Ground(scene::Surface surface);

  const scene::Surface& surface() const { return surface_; }
  RegionId size() const { return static_cast<RegionId>(surface_.regions.size()); }
  const scene::Shape& shape(RegionId id) const {
    return surface_.regions[static_cast<std::size_t>(id)].shape;
  }

  /// Whether a region is made of the cells of an image or a grid, which are half-open: docs/theory.md 5.2.
  bool is_cell(RegionId id) const { return static_cast<std::size_t>(id) < surface_.image_regions; }

  const RegionIndex& index() const { return index_; }

  /// The smallest box that contains everything that the map locates: circles, corners, points of half-planes.
  /// Without regions low is greater than high.
  const Box& extent() const { return extent_; }

  const scene::Material& material(RegionId id) const {
    return id == base_region ? surface_.base : surface_.regions[static_cast<std::size_t>(id)].material;
  }
  scene::Law law(RegionId id) const { return material(id).law; }

  /// Valid as long as the ground.
  std::string_view name(RegionId id) const {
    return id == base_region ? std::string_view(scene::base_name)
                             : std::string_view(surface_.regions[static_cast<std::size_t>(id)].name);
  }

  /// The region on top at a point, edges included. Examines only regions whose boxes contain the point.
  RegionId top_region(const Vector2d& point) const;

  /// The regions on whose edge a point lies, from the top down, without those beneath a region that has the
  /// point in its interior.
  std::vector<RegionId> edges_seen_at(const Vector2d& point) const;

  std::size_t max_crossings() const;

 private:
  scene::Surface surface_;
  RegionIndex index_;
  Box extent_;
};

}  // namespace hybrid_sphere
