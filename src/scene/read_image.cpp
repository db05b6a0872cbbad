#include "scene/read_image.hpp"

#include <filesystem>

#include "scene/cell_map.hpp"
#include "scene/grey_image.hpp"
#include "scene/read_material.hpp"
#include "scene/yaml.hpp"

namespace hybrid_sphere::scene {
namespace {

constexpr Range grey_range{0, 1, ""};
constexpr const char* name_prefix = "image_";

/// Which of an image's pixels belong to the region, and where they lie.
struct Placed {
  GreyImage image;
  double resolution = 0;
  Vector2d origin = Vector2d::Zero();
  double threshold = 0;
  bool dark = false;  ///< what is darker than white by more than the threshold, else what is lighter than it
};

std::string resolved(const std::string& file, const std::string& base_directory) {
  return (std::filesystem::path(base_directory) / file).string();
}

std::string read_file_name(const Tree& tree, const std::string& path, const char* allowed) {
  const auto name = tree.as_text();
  if (!name || name->empty()) throw SceneError(path, tree.describe(), allowed);
  return std::string(*name);
}

GreyImage read_pixels(const Tree& tree, const std::string& path, const std::string& base_directory) {
  constexpr const char* allowed = "the name of a PNG or PNM image";
  const std::string name = read_file_name(tree, path, allowed);
  try {
    return read_grey_image(resolved(name, base_directory));
  } catch (const ImageError& error) {
    const std::string where = base_directory.empty() ? "" : ", relative to \"" + base_directory + '"';
    throw SceneError(path, tree.describe() + " (" + printable(error.what()) + ")", allowed + where);
  }
}

double read_required(const MapReader& keys, const char* key, const Range& range) {
  return read_number(keys.require(key, range.describe()), keys.path_of(key), range);
}

/// The keys file, resolution, origin and rough_above.
Placed read_plain(const MapReader& keys, const Tree& file, const std::string& base_directory) {
  Placed placed;
  placed.resolution = read_required(keys, "resolution", resolution_range);
  placed.origin = read_vector2(keys.require("origin", "[x, y] [m] of the image's lower left corner"),
                               keys.path_of("origin"), coordinate_range);
  placed.threshold = read_required(keys, "rough_above", grey_range);
  placed.image = read_pixels(file, keys.path_of("file"), base_directory);
  return placed;
}

Vector2d read_origin_and_yaw(const Tree& tree, const std::string& path) {
  const std::vector<double> origin = read_numbers(tree, path, 3, coordinate_range);
  if (origin[2] != 0) {
    throw SceneError(path + "[2]", Tree(origin[2]).describe(), "0: rotated maps (yaw) are not supported");
  }
  return Vector2d(origin[0], origin[1]);
}

bool read_negate(const Tree& tree, const std::string& path) {
  if (const auto flag = tree.as_bool()) return *flag;
  const auto number = tree.as_number();
  if (number && (*number == 0 || *number == 1)) return *number == 1;
  throw SceneError(path, tree.describe(), "0, 1");
}

/// The keys of a file of map_server.
Placed read_map_server(const Tree& tree, const std::string& path, const std::string& base_directory) {
  const MapReader keys(tree, path,
                       {"image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh", "mode"});
  Placed placed;
  const Tree& image = keys.require("image", "the name of a PNG or PNM image");
  placed.resolution = read_required(keys, "resolution", resolution_range);
  placed.origin =
      read_origin_and_yaw(keys.require("origin", "[x, y, yaw] [m], [rad]"), keys.path_of("origin"));
  placed.threshold = read_required(keys, "occupied_thresh", grey_range);
  const Tree* negate = keys.find("negate");
  placed.dark = !negate || !read_negate(*negate, keys.path_of("negate"));
  if (const Tree* free = keys.find("free_thresh")) {  // unknown and free cells are one to a region
    read_number(*free, keys.path_of("free_thresh"), grey_range);
  }
  if (const Tree* mode = keys.find("mode")) read_word(*mode, keys.path_of("mode"), {"trinary", "scale"});
  placed.image = read_pixels(image, keys.path_of("image"), base_directory);
  return placed;
}

Placed read_map_server_file(const Tree& tree, const std::string& path, const std::string& base_directory) {
  constexpr const char* allowed = "the name of a map_server YAML file";
  const std::string file = resolved(read_file_name(tree, path, allowed), base_directory);
  Tree map;
  try {
    map = tree_from_yaml_file(file);
  } catch (const SceneError& error) {
    throw SceneError(path, tree.describe() + " (" + printable(error.what()) + ")", allowed);
  }
  return read_map_server(map, path, std::filesystem::path(file).parent_path().string());
}

CellMap cells_of(const Placed& placed) {
  const GreyImage& image = placed.image;
  const double white = image.white;
  CellMap cells{image.width, image.height, placed.resolution, placed.origin, {}};
  cells.belonging.reserve(image.levels.size());
  for (std::size_t row = image.height; row-- > 0;) {  // the image's first row is the uppermost
    for (std::size_t x = 0; x < image.width; ++x) {
      const std::uint32_t level = image.levels[row * image.width + x];
      const double light = level;
      const double share = (placed.dark ? white - light : light) / white;
      cells.belonging.push_back(level != GreyImage::transparent && share > placed.threshold ? 1 : 0);
    }
  }
  return cells;
}

}  // namespace

std::vector<Region> read_image(const Tree& tree, const std::string& path, const std::string& base_directory) {
  static const Keys known =
      with(with({"file", "map"}, material_keys()), {"resolution", "origin", "rough_above"});
  const MapReader keys(tree, path, known);
  const Tree* file = keys.find("file");
  const Tree* map = keys.find("map");
  if ((file != nullptr) == (map != nullptr)) {
    throw SceneError(path, file ? "both file and map" : "neither file nor map",
                     "exactly one of file (a PNG or PNM image) and map (a map_server YAML file)");
  }
  const Material material = read_material(keys, Law::rough);
  Placed placed;
  if (map) {
    for (const char* key : {"resolution", "origin", "rough_above"})
      keys.refuse(key, "the map's file sets it");
  } else {
    placed = read_plain(keys, *file, base_directory);
  }
  if (map) placed = read_map_server_file(*map, keys.path_of("map"), base_directory);
  const CellMap cells = cells_of(placed);
  placed = {};  // before the regions take memory
  return regions_of(cells, material, name_prefix, path);
}

}  // namespace hybrid_sphere::scene
