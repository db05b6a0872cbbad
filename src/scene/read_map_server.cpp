#include "scene/read_map_server.hpp"

#include <cmath>
#include <filesystem>

#include "scene/image_cells.hpp"
#include "scene/yaml.hpp"

// Source of all rules: map_server/src/image_loader.cpp and main.cpp of ROS navigation 1.17.
namespace hybrid_sphere::scene {
namespace {

constexpr double white = 255;
constexpr double least_rough = 65;       // occupancy, the default of ~grid_threshold [%]
constexpr double surely_occupied = 100;  // occupancy [%]

enum class Mode { trinary, scale, raw };

/// How levels become occupancies.
struct Interpretation {
  Mode mode = Mode::trinary;
  bool negates = false;
  double occupied = 0;    ///< occupancies above are 100 % [1]
  double free = 0.196;    ///< occupancies below are 0 % [1]
  double per_level = 1;   ///< what a level of the image is on the scale from 0 to 255
  std::string mode_path;  ///< for refusals
};

bool read_negate(const Tree& tree, const std::string& path) {
  if (const auto flag = tree.as_bool()) return *flag;
  const auto number = tree.as_number();
  if (number && (*number == 0 || *number == 1)) return *number == 1;
  throw SceneError(path, tree.describe(), "0, 1");
}

Mode read_mode(const Tree& tree, const std::string& path) {
  const std::string word = read_word(tree, path, {"trinary", "scale", "raw"});
  return word == "raw" ? Mode::raw : word == "scale" ? Mode::scale : Mode::trinary;
}

Interpretation read_interpretation(const MapReader& keys) {
  Interpretation rules;
  rules.occupied = read_required(keys, "occupied_thresh", grey_range);
  const Tree* negate = keys.find("negate");
  rules.negates = negate && read_negate(*negate, keys.path_of("negate"));
  if (const Tree* free = keys.find("free_thresh"))
    rules.free = read_number(*free, keys.path_of("free_thresh"), grey_range);
  rules.mode_path = keys.path_of("mode");
  if (const Tree* mode = keys.find("mode")) rules.mode = read_mode(*mode, rules.mode_path);
  return rules;
}

Place read_place(const MapReader& keys) {
  Place place{};
  place.resolution = read_required(keys, "resolution", resolution_range);
  const Tree& origin = keys.require("origin", "[x, y, yaw] [m], [rad]");
  const std::vector<double> numbers = read_numbers(origin, keys.path_of("origin"), 3, coordinate_range);
  place.origin = {numbers[0], numbers[1]};
  place.axis = {std::cos(numbers[2]), std::sin(numbers[2])};
  return place;
}

/// The occupancy is the level itself, as an 8-bit integer with a sign.
bool is_rough_raw(double grey, const Interpretation& rules) {
  const double level = std::floor(grey);
  if (level > surely_occupied && level != white) {
    throw SceneError(rules.mode_path, "raw, with a pixel of the level " + Tree(level).describe(),
                     "levels from 0 to 100, and 255 for unknown");
  }
  return level >= least_rough && level <= surely_occupied;
}

bool is_rough(std::uint32_t level, const Interpretation& rules) {
  const bool is_transparent = (level & GreyImage::transparent) != 0;
  double grey = (level & ~GreyImage::transparent) / rules.per_level;
  if (rules.negates) grey = white - grey;
  if (rules.mode == Mode::raw) return is_rough_raw(grey, rules);
  const double occupancy = (white - grey) / white;
  if (occupancy > rules.occupied) return true;
  if (rules.mode == Mode::trinary || occupancy < rules.free || is_transparent) return false;
  const double ratio = (occupancy - rules.free) / (rules.occupied - rules.free);
  return std::floor(1 + 98 * ratio) >= least_rough;
}

}  // namespace

CellMap read_map_server_file(const Tree& tree, const std::string& path, const std::string& base_directory,
                             std::vector<std::string>& warnings) {
  constexpr const char* allowed = "the name of a map_server YAML file";
  const std::string file = resolved(read_file_name(tree, path, allowed), base_directory);
  Tree map;
  try {
    map = tree_from_yaml_file(file);
  } catch (const SceneError& error) {
    throw SceneError(path, tree.describe() + " (" + printable(error.what()) + ")", allowed);
  }
  const MapReader keys(map, path,
                       {"image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh", "mode"},
                       warnings);
  const Tree& name = keys.require("image", allowed_images);
  const Place place = read_place(keys);
  Interpretation rules = read_interpretation(keys);
  const std::string directory = std::filesystem::path(file).parent_path().string();
  const GreyImage image =
      read_pixels(name, keys.path_of("image"), directory, {rules.mode == Mode::trinary, true});
  rules.per_level = image.white / white;
  return cells_of(image, place, [&](std::uint32_t level) { return is_rough(level, rules); });
}

}  // namespace hybrid_sphere::scene
