#pragma once

#include <filesystem>
#include <string>

#include "scene/cell_map.hpp"
#include "scene/grey_image.hpp"
#include "scene/map_reader.hpp"

/// What both kinds of image maps are read with.
namespace hybrid_sphere::scene {

inline constexpr Range grey_range{0, 1, ""};
inline constexpr const char* allowed_images = "the name of a PNG, BMP or PNM image";

inline double read_required(const MapReader& keys, const char* key, const Range& range) {
  return read_number(keys.require(key, range.describe()), keys.path_of(key), range);
}

inline std::string resolved(const std::string& file, const std::string& base_directory) {
  return (std::filesystem::path(base_directory) / file).string();
}

inline std::string read_file_name(const Tree& tree, const std::string& path, const char* allowed) {
  const auto name = tree.as_text();
  if (!name || name->empty()) throw SceneError(path, tree.describe(), allowed);
  return std::string(*name);
}

/// @throws SceneError  if the image cannot be read
inline GreyImage read_pixels(const Tree& tree, const std::string& path, const std::string& base_directory,
                             const GreyRules& rules = {}) {
  const std::string name = read_file_name(tree, path, allowed_images);
  try {
    return read_grey_image(resolved(name, base_directory), rules);
  } catch (const ImageError& error) {
    const std::string where = base_directory.empty() ? "" : ", relative to \"" + base_directory + '"';
    throw SceneError(path, tree.describe() + " (" + printable(error.what()) + ")", allowed_images + where);
  }
}

/// Where an image lies.
struct Place {
  double resolution;  ///< side of a cell [m]
  Vector2d origin;    ///< lower left corner of the lower left pixel [m]
  Vector2d axis;      ///< direction of its rows, a unit vector
};

/// The cells whose level belongs to the region.
template <class Belongs>
CellMap cells_of(const GreyImage& image, const Place& place, Belongs&& belongs) {
  CellMap cells{image.width, image.height, place.resolution, place.origin, {}, place.axis};
  cells.belonging.reserve(image.levels.size());
  for (std::size_t row = image.height; row-- > 0;) {  // the image's first row is the uppermost
    for (std::size_t x = 0; x < image.width; ++x)
      cells.belonging.push_back(belongs(image.levels[row * image.width + x]) ? 1 : 0);
  }
  return cells;
}

}  // namespace hybrid_sphere::scene
