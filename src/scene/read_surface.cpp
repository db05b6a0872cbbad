#include <algorithm>

#include "scene/check.hpp"
#include "scene/map_reader.hpp"
#include "scene/read_image.hpp"
#include "scene/read_material.hpp"
#include "scene/read_tree.hpp"

namespace hybrid_sphere::scene {
namespace {

HalfPlane read_half_plane(const Tree& tree, const std::string& path) {
  const MapReader keys(tree, path, {"point", "normal"});
  HalfPlane half_plane;
  half_plane.point =
      read_vector2(keys.require("point", "[x, y] [m]"), keys.path_of("point"), coordinate_range);
  const Tree& normal = keys.require("normal", "[x, y], not [0, 0]");
  half_plane.normal = read_vector2(normal, keys.path_of("normal"), edge_normal_range);
  if (half_plane.normal.isZero(0))
    throw SceneError(keys.path_of("normal"), normal.describe(), "[x, y], not [0, 0]");
  return half_plane;
}

Circle read_circle(const Tree& tree, const std::string& path) {
  const MapReader keys(tree, path, {"center", "radius"});
  Circle circle;
  circle.center =
      read_vector2(keys.require("center", "[x, y] [m]"), keys.path_of("center"), coordinate_range);
  circle.radius = read_number(keys.require("radius", circle_radius_range.describe()), keys.path_of("radius"),
                              circle_radius_range);
  return circle;
}

Polygon read_polygon(const Tree& tree, const std::string& path) {
  const auto corners = tree.as_list();
  if (!corners) throw SceneError(path, tree.describe(), allowed_corners);
  std::vector<Vector2d> vertices;
  vertices.reserve(corners->size());
  for (std::size_t i = 0; i < corners->size(); ++i) {
    vertices.push_back(read_vector2((*corners)[i], path + "[" + std::to_string(i) + "]", coordinate_range));
  }
  return polygon_of(std::move(vertices), path);
}

Shape read_shape(const MapReader& keys) {
  const Tree* half_plane = keys.find("half_plane");
  const Tree* circle = keys.find("circle");
  const Tree* polygon = keys.find("polygon");
  const int shapes = (half_plane != nullptr) + (circle != nullptr) + (polygon != nullptr);
  if (shapes != 1) {
    throw SceneError(keys.path(), shapes == 0 ? "no shape" : std::to_string(shapes) + " shapes",
                     "exactly one of half_plane, circle, polygon");
  }
  const Tree* outside = keys.find("outside");
  if (half_plane) {
    if (outside) {
      throw SceneError(keys.path_of("outside"), outside->describe(),
                       "a circle or a polygon; reverse a half-plane's normal instead");
    }
    return read_half_plane(*half_plane, keys.path_of("half_plane"));
  }
  const bool is_outside = outside && read_flag(*outside, keys.path_of("outside"));
  if (circle) {
    Circle shape = read_circle(*circle, keys.path_of("circle"));
    shape.outside = is_outside;
    return shape;
  }
  Polygon shape = read_polygon(*polygon, keys.path_of("polygon"));
  shape.outside = is_outside;
  return shape;
}

std::string read_name(const MapReader& keys) {
  const Tree& tree = keys.require("name", allowed_names());
  const auto name = tree.as_text();
  if (!name) throw SceneError(keys.path_of("name"), tree.describe(), allowed_names());
  check_name(*name, keys.path_of("name"));
  return std::string(*name);
}

Region read_region(const Tree& tree, const std::string& path) {
  static const Keys known =
      with({"name"}, with(material_keys(), {"half_plane", "circle", "polygon", "outside"}));
  const MapReader keys(tree, path, known);
  Region region;
  region.name = read_name(keys);
  region.material = read_material(keys);
  region.shape = read_shape(keys);
  return region;
}

Material read_base(const Tree& tree, const std::string& path) {
  return read_material(MapReader(tree, path, material_keys()));
}

/// Appends the listed regions; `surface` holds those of the image.
void read_regions(const Tree& tree, const std::string& path, Surface& surface) {
  const auto list = tree.as_list();
  if (!list) throw SceneError(path, tree.describe(), "a list of regions");
  surface.regions.reserve(surface.regions.size() + list->size());
  for (std::size_t i = 0; i < list->size(); ++i) {
    surface.regions.push_back(read_region((*list)[i], path + "[" + std::to_string(i) + "]"));
  }
  check_names(surface, path);
}

}  // namespace

Surface read_surface(const Tree& tree, const std::string& path, const std::string& base_directory,
                     std::vector<std::string>* warnings) {
  const MapReader keys(tree, path, {"base", "image", "regions", "livelock"});
  Surface surface;
  if (const Tree* base = keys.find("base")) surface.base = read_base(*base, keys.path_of("base"));
  if (const Tree* image = keys.find("image")) {
    std::vector<std::string> ignored;
    surface.regions =
        read_image(*image, keys.path_of("image"), base_directory, warnings ? *warnings : ignored);
    surface.image_regions = surface.regions.size();
  }
  if (const Tree* regions = keys.find("regions")) read_regions(*regions, keys.path_of("regions"), surface);
  if (const Tree* livelock = keys.find("livelock")) {
    const std::string word = read_word(*livelock, keys.path_of("livelock"), {"slide", "stop"});
    surface.livelock = word == "stop" ? Livelock::stop : Livelock::slide;
  }
  return surface;
}

}  // namespace hybrid_sphere::scene
