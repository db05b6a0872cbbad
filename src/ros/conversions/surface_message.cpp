#include "ros/conversions/surface_message.hpp"

#include <utility>

#include "scene/check.hpp"
#include "scene/tree.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

using scene::SceneError;
using scene::Tree;

constexpr const char* laws = "0 (SMOOTH), 1 (ROUGH), 2 (RUBBER), 3 (COULOMB)";

std::string described(double number) { return Tree(number).describe(); }

Vector2d planar(double x, double y, double z, const std::string& path) {
  if (z != 0) throw SceneError(path + ".z", described(z), "0: the ground is flat");
  return {x, y};
}

/// Points of one region, and how to name them in errors.
struct Points {
  const SurfaceRegion& region;
  const std::string& path;
  const PlanarTransform& to_world;

  Vector2d at(std::size_t i) const {
    const geometry_msgs::Point& point = region.points[i];
    return to_world.point(planar(point.x, point.y, point.z, path + ".points[" + std::to_string(i) + "]"));
  }

  Vector2d only(const char* what) const {
    if (region.points.size() != 1) {
      throw SceneError(path + ".points", std::to_string(region.points.size()) + " points", what);
    }
    return at(0);
  }

  std::vector<Vector2d> all() const {
    std::vector<Vector2d> list;
    list.reserve(region.points.size());
    for (std::size_t i = 0; i < region.points.size(); ++i) list.push_back(at(i));
    return list;
  }
};

scene::Shape shape_of(const SurfaceRegion& region, const std::string& path, const PlanarTransform& to_world) {
  const Points points{region, path, to_world};
  switch (region.shape) {
    case SurfaceRegion::HALF_PLANE: {
      const auto& n = region.normal;
      if (region.outside) {
        throw SceneError(path + ".outside", "true",
                         "a circle or a polygon; reverse a half-plane's normal instead");
      }
      const scene::HalfPlane half_plane{points.only("1 point: any on the edge"),
                                        to_world.direction(planar(n.x, n.y, n.z, path + ".normal"))};
      scene::check_half_plane(half_plane, path + ".half_plane");
      return half_plane;
    }
    case SurfaceRegion::CIRCLE: {
      const scene::Circle circle{points.only("1 point: the centre"), region.radius, region.outside != 0};
      scene::check_circle(circle, path + ".circle");
      return circle;
    }
    case SurfaceRegion::POLYGON: {
      scene::Polygon polygon = scene::polygon_of(points.all(), path + ".polygon");
      polygon.outside = region.outside != 0;
      return polygon;
    }
    case SurfaceRegion::EVERYWHERE:
      throw SceneError(path + ".shape", "0 (EVERYWHERE)", "1 (HALF_PLANE), 2 (CIRCLE), 3 (POLYGON)");
    default: break;
  }
  throw SceneError(path + ".shape", std::to_string(region.shape), "1 (HALF_PLANE), 2 (CIRCLE), 3 (POLYGON)");
}

scene::Law law_of(const SurfaceRegion& region, const std::string& path) {
  switch (region.law) {
    case SurfaceRegion::SMOOTH: return scene::Law::smooth;
    case SurfaceRegion::ROUGH: return scene::Law::rough;
    case SurfaceRegion::RUBBER: return scene::Law::rubber;
    case SurfaceRegion::COULOMB: return scene::Law::coulomb;
    default: break;
  }
  throw SceneError(path + ".law", std::to_string(region.law), laws);
}

scene::Material material_of(const SurfaceRegion& region, const std::string& path,
                            const PlanarTransform& to_world) {
  scene::Material material(law_of(region, path));
  material.friction = region.friction;
  material.rolling_resistance = region.rolling_resistance;
  material.spin_friction = region.spin_friction;
  const auto& belt = region.belt;
  material.belt = to_world.direction(planar(belt.x, belt.y, belt.z, path + ".belt"));
  if (region.turntable_rate != 0) {
    const auto& center = region.turntable_center;
    material.turntable_rate = region.turntable_rate;
    material.turntable_center =
        to_world.point(planar(center.x, center.y, center.z, path + ".turntable_center"));
  }
  scene::check_material(material, path);
  return material;
}

scene::Material base_of(const SurfaceRegion& base, const std::string& path, const PlanarTransform& to_world) {
  if (base.shape != SurfaceRegion::EVERYWHERE) {
    throw SceneError(path + ".shape", std::to_string(base.shape), "0 (EVERYWHERE)");
  }
  if (!base.name.empty() && base.name != scene::base_name) {
    throw SceneError(path + ".name", Tree(base.name).describe(), "\"base\", or empty");
  }
  return material_of(base, path, to_world);
}

scene::Region region_of(const SurfaceRegion& region, const std::string& path,
                        const PlanarTransform& to_world) {
  scene::check_name(region.name, path + ".name");
  const scene::Material material = material_of(region, path, to_world);
  return {region.name, shape_of(region, path, to_world), material};
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
    throw SceneError("map.regions", std::to_string(points) + " points in all regions",
                     "up to " + std::to_string(max_map_points));
  }
}

scene::Livelock livelock_of(const SurfaceMap& message) {
  switch (message.livelock) {
    case SurfaceMap::SLIDE: return scene::Livelock::slide;
    case SurfaceMap::STOP: return scene::Livelock::stop;
    default: break;
  }
  throw SceneError("map.livelock", std::to_string(message.livelock), "0 (SLIDE), 1 (STOP)");
}

}  // namespace

scene::Surface surface_from_message(const SurfaceMap& message, const PlanarTransform& to_world,
                                    const scene::Forces& forces) {
  check_size(message);
  scene::Surface surface;
  surface.livelock = livelock_of(message);
  surface.base = base_of(message.base, "map.base", to_world);
  surface.regions.reserve(message.regions.size());
  for (std::size_t i = 0; i < message.regions.size(); ++i) {
    surface.regions.push_back(
        region_of(message.regions[i], "map.regions[" + std::to_string(i) + "]", to_world));
  }
  scene::check_names(surface, "map.regions");
  scene::check_pressure(surface, forces, "map");
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
