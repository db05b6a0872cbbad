#include "scene/check.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_set>
#include <utility>

#include "geometry/simple_polygon.hpp"
#include "scene/printable.hpp"
#include "scene/ranges.hpp"
#include "scene/tree.hpp"

namespace hybrid_sphere::scene {
namespace {

void check_number(double number, const std::string& path, const Range& range) {
  if (range.holds(number)) return;
  const bool is_small = Range{range.low, range.high, range.unit, 0}.holds(number);
  throw SceneError(path, Tree(number).describe(), is_small ? range.describe_least() : range.describe());
}

template <class Numbers>
void check_numbers(const Numbers& numbers, const std::string& path, const Range& range) {
  for (Eigen::Index i = 0; i < numbers.size(); ++i) {
    if (!range.holds(numbers[i])) check_number(numbers[i], path + "[" + std::to_string(i) + "]", range);
  }
}

std::string joined(const std::string& path, const char* key) { return path.empty() ? key : path + "." + key; }

void refuse_unless_zero(double number, const std::string& path, const char* why) {
  if (number == 0) return;
  throw SceneError(path, Tree(number).describe(), std::string("0: ") + why);
}

void check_ground_motion(const Material& material, const std::string& path) {
  if (material.law == Law::smooth) {
    constexpr const char* why = "smooth ground drags nothing along, moving or not";
    if (!material.belt.isZero(0)) {
      const Tree::List belt{material.belt.x(), material.belt.y()};
      throw SceneError(path + ".belt", Tree(belt).describe(), std::string("[0, 0]: ") + why);
    }
    refuse_unless_zero(material.turntable_rate, path + ".turntable.rate", why);
    return;
  }
  check_numbers(material.belt, path + ".belt", belt_range);
  check_number(material.turntable_rate, path + ".turntable.rate", rate_range);
  check_numbers(material.turntable_center, path + ".turntable.center", coordinate_range);
  if (!material.belt.isZero(0) && material.turntable_rate != 0) {
    throw SceneError(path + ".turntable",
                     "a rate of " + Tree(material.turntable_rate).describe() + " together with belt",
                     "at most one of belt and turntable");
  }
}

void check_coordinates(const std::vector<Vector2d>& corners, const std::string& path) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const bool holds = coordinate_range.holds(corners[i].x()) && coordinate_range.holds(corners[i].y());
    if (!holds) check_numbers(corners[i], path + "[" + std::to_string(i) + "]", coordinate_range);
  }
}

void check_shape(const Shape& shape, const std::string& path) {
  if (const auto* half_plane = std::get_if<HalfPlane>(&shape)) {
    check_half_plane(*half_plane, path + ".half_plane");
  } else if (const auto* circle = std::get_if<Circle>(&shape)) {
    check_circle(*circle, path + ".circle");
  } else {
    const std::vector<Vector2d>& corners = std::get<Polygon>(shape).vertices;
    check_coordinates(corners, path + ".polygon");
    check_corners(corners, path + ".polygon");
    if (!geometry::is_counter_clockwise(corners)) {
      throw SceneError(path + ".polygon", "a clockwise order", "corners in counter-clockwise order");
    }
  }
}

}  // namespace

void check_sphere(const SphereBody& sphere, const std::string& path) {
  check_number(sphere.mass, joined(path, "mass"), mass_range);
  check_number(sphere.radius, joined(path, "radius"), radius_range);
  check_number(sphere.gyration_radius, joined(path, "gyration_radius"), gyration_range(sphere.radius));
}

void check_unit(const Quaterniond& orientation, const std::string& path) {
  if (std::abs(orientation.norm() - 1) <= unit_slack) return;
  const auto& q = orientation.coeffs();
  throw SceneError(path, Tree(Tree::List{q[0], q[1], q[2], q[3]}).describe(),
                   "a unit quaternion x, y, z, w (normalized if its length is within 1 % of 1)");
}

void check_initial_state(const InitialState& state, const std::string& path) {
  check_numbers(state.position, joined(path, "position"), coordinate_range);
  check_numbers(state.orientation.coeffs(), joined(path, "orientation"), quaternion_range);
  check_unit(state.orientation, joined(path, "orientation"));
  check_numbers(state.velocity, joined(path, "velocity"), velocity_range);
  check_numbers(state.angular_velocity, joined(path, "angular_velocity"), spin_range);
}

void check_solver(const Solver& solver, const std::string& path) {
  if (*to_string(solver.method) == 0) {
    throw SceneError(joined(path, "method"), "an unknown value", "those of scene::method_names");
  }
  check_number(solver.accuracy, joined(path, "accuracy"), accuracy_range);
  check_number(solver.step, joined(path, "step"), step_range);
}

void check_wrench(const Wrench& wrench, const SphereBody& sphere, const std::string& path) {
  check_numbers(wrench.force, joined(path, "force"), force_range(sphere));
  check_numbers(wrench.torque, joined(path, "torque"), torque_range(sphere));
}

void check_forces(const Forces& forces, const SphereBody& sphere, const std::string& path) {
  const std::string gravity = joined(path, "gravity");
  check_numbers(forces.gravity, gravity, in_plane_range);
  check_number(forces.gravity.z(), gravity + "[2]", normal_range);
  check_wrench(forces.wrench, sphere, joined(path, "wrench"));
  const std::string drag = joined(path, "drag");
  check_number(forces.drag.translational, drag + ".translational", translational_drag_range(sphere));
  check_number(forces.drag.rotational, drag + ".rotational", rotational_drag_range(sphere));
  check_number(forces.drag.quadratic, drag + ".quadratic", quadratic_drag_range(sphere));
  const std::string spring = joined(path, "spring");
  check_numbers(forces.spring.center, spring + ".center", coordinate_range);
  check_number(forces.spring.stiffness, spring + ".stiffness", stiffness_range(sphere));
}

void check_material(const Material& material, const std::string& path) {
  if (*to_string(material.law) == 0) {
    throw SceneError(path + ".law", "an unknown value", "smooth, rough, rubber, coulomb");
  }
  if (material.law == Law::coulomb) {
    check_number(material.friction, path + ".friction", coefficient_range);
  } else {
    refuse_unless_zero(material.friction, path + ".friction",
                       "only the law coulomb has a coefficient of friction");
  }
  if (material.law == Law::smooth) {
    refuse_unless_zero(material.rolling_resistance, path + ".rolling_resistance",
                       "nothing rolls on smooth ground");
    refuse_unless_zero(material.spin_friction, path + ".spin_friction", "smooth ground has no friction");
  } else {
    check_number(material.rolling_resistance, path + ".rolling_resistance", coefficient_range);
  }
  if (material.law == Law::rubber) {
    refuse_unless_zero(material.spin_friction, path + ".spin_friction",
                       "the law rubber leaves no spin relative to the ground for it to act on");
  } else if (material.law != Law::smooth) {
    check_number(material.spin_friction, path + ".spin_friction", coefficient_range);
  }
  check_ground_motion(material, path);
}

std::string allowed_names() {
  return "printable UTF-8 text of 1 to " + std::to_string(longest_name) + " bytes, not \"" + base_name + "\"";
}

void check_name(std::string_view name, const std::string& path) {
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  const bool is_name = !name.empty() && name.size() <= longest_name && name != base_name &&
                       std::none_of(name.begin(), name.end(), is_control) && is_utf8(name);
  if (!is_name) throw SceneError(path, Tree(name).describe(), allowed_names());
}

void check_names(const Surface& surface, const std::string& path) {
  std::unordered_set<std::string_view> names;
  names.reserve(surface.regions.size());
  for (std::size_t i = 0; i < surface.regions.size(); ++i) {
    const std::string& name = surface.regions[i].name;
    if (names.insert(name).second) continue;
    const std::size_t listed = i < surface.image_regions ? i : i - surface.image_regions;
    throw SceneError(path + "[" + std::to_string(listed) + "].name", Tree(name).describe(),
                     std::string("a name that no other region has") +
                         (surface.image_regions > 0 ? ", including the image's (image_0 ...)" : ""));
  }
}

void check_half_plane(const HalfPlane& half_plane, const std::string& path) {
  check_numbers(half_plane.point, path + ".point", coordinate_range);
  check_numbers(half_plane.normal, path + ".normal", edge_normal_range);
  if (half_plane.normal.isZero(0)) throw SceneError(path + ".normal", "[0, 0]", "[x, y], not [0, 0]");
}

void check_circle(const Circle& circle, const std::string& path) {
  check_numbers(circle.center, path + ".center", coordinate_range);
  check_number(circle.radius, path + ".radius", circle_radius_range);
}

Polygon polygon_of(std::vector<Vector2d> corners, const std::string& path) {
  check_coordinates(corners, path);
  check_corners(corners, path);
  if (!geometry::is_counter_clockwise(corners)) std::reverse(corners.begin(), corners.end());
  return {std::move(corners), false};
}

void check_corners(const std::vector<Vector2d>& corners, const std::string& path) {
  const auto fault = geometry::fault_of_polygon(corners);
  if (!fault) return;
  const std::string shown = corners.empty() ? "[]" : "a list of " + std::to_string(corners.size());
  throw SceneError(path, shown + " (" + *fault + ")", allowed_corners);
}

void check_surface(const Surface& surface, const std::string& path) {
  if (surface.image_regions > surface.regions.size()) {
    throw SceneError(path + ".image_regions", std::to_string(surface.image_regions),
                     "up to the number of regions, " + std::to_string(surface.regions.size()));
  }
  check_material(surface.base, path + ".base");
  for (std::size_t i = 0; i < surface.regions.size(); ++i) {
    const Region& region = surface.regions[i];
    const bool is_cell = i < surface.image_regions;
    const std::string place = path + (is_cell ? ".image[" : ".regions[") +
                              std::to_string(is_cell ? i : i - surface.image_regions) + "]";
    if (is_cell && !std::holds_alternative<Polygon>(region.shape)) {
      throw SceneError(place, "a shape other than a polygon", "polygons: the cells of an image");
    }
    check_name(region.name, place + ".name");
    check_material(region.material, place);
    check_shape(region.shape, place);
  }
  if (surface.livelock != Livelock::slide && surface.livelock != Livelock::stop) {
    throw SceneError(path + ".livelock", "an unknown value", "slide, stop");
  }
  check_names(surface, path + ".regions");
}

void check_pressure(const Material& material, const Forces& forces, const std::string& path) {
  const double z = forces.gravity.z();
  if (z < 0) return;
  const std::string only_while =
      " only while gravity presses the sphere onto the ground, gravity[2] < 0; it is " + Tree(z).describe();
  if (material.law == Law::coulomb) {
    throw SceneError(path + ".law", Tree(to_string(material.law)).describe(),
                     "smooth, rough, rubber; coulomb" + only_while);
  }
  if (material.rolling_resistance != 0) {
    throw SceneError(path + ".rolling_resistance", Tree(material.rolling_resistance).describe(),
                     "0; more" + only_while);
  }
  if (material.spin_friction != 0) {
    throw SceneError(path + ".spin_friction", Tree(material.spin_friction).describe(),
                     "0; more" + only_while);
  }
}

void check_pressure(const Surface& surface, const Forces& forces, const std::string& path) {
  if (forces.gravity.z() < 0) return;
  check_pressure(surface.base, forces, path + ".base");
  for (std::size_t i = 0; i < surface.regions.size(); ++i) {
    const Material& material = surface.regions[i].material;
    if (i < surface.image_regions) {
      check_pressure(material, forces, path + ".image");
    } else {
      check_pressure(material, forces, path + ".regions[" + std::to_string(i - surface.image_regions) + "]");
    }
  }
}

}  // namespace hybrid_sphere::scene
