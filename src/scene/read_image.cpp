#include "scene/read_image.hpp"

#include "scene/image_cells.hpp"
#include "scene/read_map_server.hpp"
#include "scene/read_material.hpp"

namespace hybrid_sphere::scene {
namespace {

constexpr const char* name_prefix = "image_";

/// The keys file, resolution, origin and rough_above.
CellMap read_plain(const MapReader& keys, const Tree& file, const std::string& base_directory) {
  const double resolution = read_required(keys, "resolution", resolution_range);
  const Vector2d origin = read_vector2(keys.require("origin", "[x, y] [m] of the image's lower left corner"),
                                       keys.path_of("origin"), coordinate_range);
  const double threshold = read_required(keys, "rough_above", grey_range);
  const GreyImage image = read_pixels(file, keys.path_of("file"), base_directory);
  const double white = image.white;
  return cells_of(image, {resolution, origin, Vector2d::UnitX()}, [&](std::uint32_t level) {
    return (level & GreyImage::transparent) == 0 && level / white > threshold;
  });
}

}  // namespace

std::vector<Region> read_image(const Tree& tree, const std::string& path, const std::string& base_directory,
                               std::vector<std::string>& warnings) {
  static const Keys known =
      with(with({"file", "map"}, material_keys()), {"resolution", "origin", "rough_above"});
  const MapReader keys(tree, path, known);
  const Tree* file = keys.find("file");
  const Tree* map = keys.find("map");
  if ((file != nullptr) == (map != nullptr)) {
    throw SceneError(path, file ? "both file and map" : "neither file nor map",
                     "exactly one of file (a PNG, BMP or PNM image) and map (a map_server YAML file)");
  }
  const Material material = read_material(keys, Law::rough);
  if (map) {
    for (const char* key : {"resolution", "origin", "rough_above"})
      keys.refuse(key, "the map's file sets it");
  }
  const CellMap cells = map ? read_map_server_file(*map, keys.path_of("map"), base_directory, warnings)
                            : read_plain(keys, *file, base_directory);
  return regions_of(cells, material, name_prefix, path);
}

}  // namespace hybrid_sphere::scene
