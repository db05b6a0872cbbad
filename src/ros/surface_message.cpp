#include "ros/surface_message.hpp"

#include <utility>

#include "scene/read_tree.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

using scene::SceneError;
using scene::Tree;

constexpr const char* laws = "0 (SMOOTH), 1 (ROUGH), 2 (RUBBER), 3 (COULOMB)";

std::string described(double number) { return Tree(number).describe(); }

void refuse_unless_zero(double number, const std::string& path, const std::string& allowed) {
  if (number != 0) throw SceneError(path, described(number), allowed);
}

Tree::List planar(double x, double y, double z, const std::string& path) {
  refuse_unless_zero(z, path + ".z", "0: the ground is flat");
  return {Tree(x), Tree(y)};
}

/// Points of one region, and how to name them in errors.
struct Points {
  const SurfaceRegion& region;
  const std::string& path;

  Tree::List at(std::size_t i) const {
    const geometry_msgs::Point& point = region.points[i];
    return planar(point.x, point.y, point.z, path + ".points[" + std::to_string(i) + "]");
  }

  Tree::List only(const char* what) const {
    if (region.points.size() != 1) {
      throw SceneError(path + ".points", std::to_string(region.points.size()) + " points", what);
    }
    return at(0);
  }

  Tree::List all() const {
    Tree::List list;
    for (std::size_t i = 0; i < region.points.size(); ++i) list.emplace_back(at(i));
    return list;
  }
};

std::pair<std::string, Tree> shape_of(const SurfaceRegion& region, const std::string& path) {
  const Points points{region, path};
  switch (region.shape) {
    case SurfaceRegion::HALF_PLANE: {
      const auto& n = region.normal;
      return {"half_plane", Tree::Map{{"point", points.only("1 point: one of the edge")},
                                      {"normal", planar(n.x, n.y, n.z, path + ".normal")}}};
    }
    case SurfaceRegion::CIRCLE:
      return {"circle", Tree::Map{{"center", points.only("1 point: the centre")}, {"radius", region.radius}}};
    case SurfaceRegion::POLYGON: return {"polygon", points.all()};
    case SurfaceRegion::EVERYWHERE:
      throw SceneError(path + ".shape", "0 (EVERYWHERE)", "1 (HALF_PLANE), 2 (CIRCLE), 3 (POLYGON)");
    default: break;
  }
  throw SceneError(path + ".shape", std::to_string(region.shape), "1 (HALF_PLANE), 2 (CIRCLE), 3 (POLYGON)");
}

std::string law_of(const SurfaceRegion& region, const std::string& path) {
  switch (region.law) {
    case SurfaceRegion::SMOOTH: return "smooth";
    case SurfaceRegion::ROUGH: return "rough";
    case SurfaceRegion::RUBBER: return "rubber";
    case SurfaceRegion::COULOMB: return "coulomb";
    default: break;
  }
  throw SceneError(path + ".law", std::to_string(region.law), laws);
}

/// The keys of a material; a coefficient of 0 is one that is not given, but for the friction that a law
/// needs.
void add_material(const SurfaceRegion& region, const std::string& path, Tree::Map& keys) {
  keys.emplace_back("law", law_of(region, path));
  if (region.law == SurfaceRegion::COULOMB || region.friction != 0) {
    keys.emplace_back("friction", region.friction);
  }
  if (region.rolling_resistance != 0) keys.emplace_back("rolling_resistance", region.rolling_resistance);
  if (region.spin_friction != 0) keys.emplace_back("spin_friction", region.spin_friction);
  const auto& belt = region.belt;
  Tree::List belt_velocity = planar(belt.x, belt.y, belt.z, path + ".belt");
  if (belt.x != 0 || belt.y != 0) keys.emplace_back("belt", std::move(belt_velocity));
  if (region.turntable_rate != 0) {
    const auto& center = region.turntable_center;
    keys.emplace_back(
        "turntable", Tree::Map{{"rate", region.turntable_rate},
                               {"center", planar(center.x, center.y, center.z, path + ".turntable_center")}});
  }
}

Tree tree_from_base(const SurfaceRegion& base, const std::string& path) {
  if (base.shape != SurfaceRegion::EVERYWHERE) {
    throw SceneError(path + ".shape", std::to_string(base.shape), "0 (EVERYWHERE)");
  }
  if (!base.name.empty() && base.name != scene::base_name) {
    throw SceneError(path + ".name", Tree(base.name).describe(), "\"base\", or empty");
  }
  Tree::Map keys;
  add_material(base, path, keys);
  return keys;
}

Tree tree_from_region(const SurfaceRegion& region, const std::string& path) {
  Tree::Map keys{{"name", region.name}};
  add_material(region, path, keys);
  keys.push_back(shape_of(region, path));
  if (region.outside) keys.emplace_back("outside", true);
  return keys;
}

geometry_msgs::Point point_from(const Vector2d& v) {
  geometry_msgs::Point point;
  point.x = v.x();
  point.y = v.y();
  return point;
}

/// Writes a shape into a message.
struct ShapeWriter {
  SurfaceRegion& region;

  void operator()(const scene::HalfPlane& half_plane) const {
    region.shape = SurfaceRegion::HALF_PLANE;
    region.points.push_back(point_from(half_plane.point));
    region.normal.x = half_plane.normal.x();
    region.normal.y = half_plane.normal.y();
  }
  void operator()(const scene::Circle& circle) const {
    region.shape = SurfaceRegion::CIRCLE;
    region.points.push_back(point_from(circle.center));
    region.radius = circle.radius;
    region.outside = circle.outside;
  }
  void operator()(const scene::Polygon& polygon) const {
    region.shape = SurfaceRegion::POLYGON;
    for (const Vector2d& vertex : polygon.vertices) region.points.push_back(point_from(vertex));
    region.outside = polygon.outside;
  }
};

std::uint8_t law_to_message(scene::Law law) {
  switch (law) {
    case scene::Law::smooth: return SurfaceRegion::SMOOTH;
    case scene::Law::rough: return SurfaceRegion::ROUGH;
    case scene::Law::rubber: return SurfaceRegion::RUBBER;
    case scene::Law::coulomb: return SurfaceRegion::COULOMB;
  }
  return SurfaceRegion::SMOOTH;
}

void write_material(const scene::Material& material, SurfaceRegion& region) {
  region.law = law_to_message(material.law);
  region.friction = material.friction;
  region.rolling_resistance = material.rolling_resistance;
  region.spin_friction = material.spin_friction;
  region.belt.x = material.belt.x();
  region.belt.y = material.belt.y();
  region.turntable_rate = material.turntable_rate;
  region.turntable_center = point_from(material.turntable_center);
}

/// Before anything is copied.
void check_size(const SurfaceMap& message) {
  if (message.regions.size() > max_map_regions) {
    throw SceneError("map.regions", std::to_string(message.regions.size()) + " regions",
                     "up to " + std::to_string(max_map_regions));
  }
  std::size_t points = 0;
  for (const SurfaceRegion& region : message.regions) points += region.points.size();
  if (points > max_map_points) {
    throw SceneError("map.regions", std::to_string(points) + " points of all regions",
                     "up to " + std::to_string(max_map_points));
  }
}

std::string livelock_of(const SurfaceMap& message) {
  switch (message.livelock) {
    case SurfaceMap::SLIDE: return "slide";
    case SurfaceMap::STOP: return "stop";
    default: break;
  }
  throw SceneError("map.livelock", std::to_string(message.livelock), "0 (SLIDE), 1 (STOP)");
}

}  // namespace

Tree tree_from_message(const SurfaceMap& message, const std::string& world_frame) {
  const std::string& frame = message.header.frame_id;
  if (!frame.empty() && frame != world_frame) {
    throw SceneError("map.header.frame_id", Tree(frame).describe(),
                     Tree(world_frame).describe() + ", or empty");
  }
  check_size(message);
  const std::string livelock = livelock_of(message);
  Tree::List regions;
  for (std::size_t i = 0; i < message.regions.size(); ++i) {
    regions.push_back(tree_from_region(message.regions[i], "map.regions[" + std::to_string(i) + "]"));
  }
  return Tree::Map{{"base", tree_from_base(message.base, "map.base")},
                   {"regions", std::move(regions)},
                   {"livelock", livelock}};
}

scene::Surface surface_from_message(const SurfaceMap& message, const std::string& world_frame,
                                    const scene::Forces& forces) {
  scene::Surface surface = scene::read_surface(tree_from_message(message, world_frame), "map");
  scene::check_surface(surface, forces, "map");
  return surface;
}

SurfaceMap message_from_surface(const scene::Surface& surface) {
  SurfaceMap message;
  message.base.name = scene::base_name;
  message.base.shape = SurfaceRegion::EVERYWHERE;
  write_material(surface.base, message.base);
  message.regions.reserve(surface.regions.size());
  for (const scene::Region& region : surface.regions) {
    SurfaceRegion& written = message.regions.emplace_back();
    written.name = region.name;
    write_material(region.material, written);
    std::visit(ShapeWriter{written}, region.shape);
  }
  message.livelock = surface.livelock == scene::Livelock::stop ? SurfaceMap::STOP : SurfaceMap::SLIDE;
  return message;
}

}  // namespace hybrid_sphere::ros_interface
