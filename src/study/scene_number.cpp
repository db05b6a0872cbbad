#include "study/scene_number.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>
#include <variant>

#include "scene/printable.hpp"
#include "study/nearest.hpp"

namespace hybrid_sphere::study {
namespace {

using scene::Law;
using scene::Scene;
using scene::SceneError;
using scene::TreePlace;

template <class Vector>
SceneField list(const std::string& path, Vector& numbers, const scene::Range& range) {
  return {path, numbers.data(), static_cast<std::size_t>(numbers.size()), range};
}

SceneField number(const std::string& path, double& value, const scene::Range& range) {
  return {path, &value, 0, range};
}

SceneField bounded_by_sphere(SceneField field) {
  field.is_bounded_by_sphere = true;
  return field;
}

/// Those that the law has.
void add_material(scene::Material& material, const std::string& path, std::vector<SceneField>& fields) {
  if (material.law == Law::smooth) return;
  if (material.law == Law::coulomb) {
    fields.push_back(number(path + ".friction", material.friction, scene::coefficient_range));
  }
  fields.push_back(
      number(path + ".rolling_resistance", material.rolling_resistance, scene::coefficient_range));
  if (material.law != Law::rubber) {
    fields.push_back(number(path + ".spin_friction", material.spin_friction, scene::coefficient_range));
  }
  if (material.turntable_rate != 0) {
    fields.push_back(number(path + ".turntable.rate", material.turntable_rate, scene::rate_range));
    fields.push_back(list(path + ".turntable.center", material.turntable_center, scene::coordinate_range));
  } else {
    fields.push_back(list(path + ".belt", material.belt, scene::belt_range));
  }
}

void add_shape(scene::Shape& shape, const std::string& path, std::vector<SceneField>& fields) {
  if (auto* half_plane = std::get_if<scene::HalfPlane>(&shape)) {
    fields.push_back(list(path + ".half_plane.point", half_plane->point, scene::coordinate_range));
    fields.push_back(list(path + ".half_plane.normal", half_plane->normal, scene::edge_normal_range));
  } else if (auto* circle = std::get_if<scene::Circle>(&shape)) {
    fields.push_back(list(path + ".circle.center", circle->center, scene::coordinate_range));
    fields.push_back(number(path + ".circle.radius", circle->radius, scene::circle_radius_range));
  }
}

/// All but those of regions.
std::vector<SceneField> fields_of(Scene& scene) {
  scene::SphereBody& body = scene.sphere;
  scene::InitialState& start = scene.initial_state;
  scene::Forces& forces = scene.forces;
  std::vector<SceneField> fields = {
      number("sphere.mass", body.mass, scene::mass_range),
      number("sphere.radius", body.radius, scene::radius_range),
      bounded_by_sphere(
          number("sphere.gyration_radius", body.gyration_radius, scene::gyration_range(body.radius))),
      list("initial_state.position", start.position, scene::coordinate_range),
      list("initial_state.velocity", start.velocity, scene::velocity_range),
      list("initial_state.angular_velocity", start.angular_velocity, scene::spin_range),
      list("gravity", forces.gravity, scene::in_plane_range),
      bounded_by_sphere(list("wrench.force", forces.wrench.force, scene::force_range(body))),
      bounded_by_sphere(list("wrench.torque", forces.wrench.torque, scene::torque_range(body))),
      bounded_by_sphere(
          number("drag.translational", forces.drag.translational, scene::translational_drag_range(body))),
      bounded_by_sphere(
          number("drag.rotational", forces.drag.rotational, scene::rotational_drag_range(body))),
      bounded_by_sphere(number("drag.quadratic", forces.drag.quadratic, scene::quadratic_drag_range(body))),
      bounded_by_sphere(number("spring.stiffness", forces.spring.stiffness, scene::stiffness_range(body))),
      list("spring.center", forces.spring.center, scene::coordinate_range),
      number("solver.accuracy", scene.solver.accuracy, scene::accuracy_range),
      number("solver.step", scene.solver.step, scene::step_range),
  };
  add_material(scene.surface.base, "surface.base", fields);
  return fields;
}

std::vector<SceneField> fields_of(scene::Region& region, std::size_t index) {
  const std::string path = "surface.regions[" + std::to_string(index) + "]";
  std::vector<SceneField> fields;
  add_material(region.material, path, fields);
  add_shape(region.shape, path, fields);
  return fields;
}

/// The number that a text spells as std::to_string would.
std::optional<std::size_t> index_of(std::string_view text) {
  std::size_t index = 0;
  const char* const end = text.data() + text.size();
  const auto [read, error] = std::from_chars(text.data(), end, index);
  const bool is_index = error == std::errc() && read == end && (text.size() == 1 || text.front() != '0');
  return is_index ? std::optional(index) : std::nullopt;
}

/// The steps of a path: keys with points between them, indices in brackets.
std::optional<TreePlace> place_of(std::string_view path) {
  TreePlace place;
  std::size_t i = 0;
  while (i < path.size()) {
    if (path[i] == '[') {
      const std::size_t end = path.find(']', i);
      const auto index = end == path.npos ? std::nullopt : index_of(path.substr(i + 1, end - i - 1));
      if (!index) return std::nullopt;
      place.emplace_back(*index);
      i = end + 1;
    } else {
      if (i > 0 && path[i++] != '.') return std::nullopt;
      const std::size_t end = std::min(path.find_first_of(".[", i), path.size());
      if (end == i) return std::nullopt;
      place.emplace_back(std::string(path.substr(i, end - i)));
      i = end;
    }
  }
  return place;
}

const std::string regions = "surface.regions[";

/// The path with the region's index in place of its name; of several names that fit, of the longest one.
std::string with_index(const Scene& scene, const std::string& path, const std::string& where) {
  if (path.rfind(regions, 0) != 0) return path;
  const std::size_t first = scene.surface.image_regions;
  std::vector<std::string> names;
  std::optional<std::size_t> found;
  for (std::size_t i = first; i < scene.surface.regions.size(); ++i) {
    const std::string& name = scene.surface.regions[i].name;
    const bool fits = path.compare(regions.size(), name.size() + 1, name + "]") == 0;
    if (fits && (!found || name.size() > names[*found].size())) found = names.size();
    names.push_back(name);
  }
  if (found) return regions + std::to_string(*found) + path.substr(regions.size() + names[*found].size());
  const std::string name = path.substr(regions.size(), path.find(']') - regions.size());
  const auto index = index_of(name);
  if (index && *index < names.size()) return path;
  throw SceneError(where, "region \"" + scene::printable(name) + "\"",
                   names.empty() ? "a scene with regions that have names"
                                 : "the name of a region of the scene; the nearest one is \"" +
                                       nearest(name, names) + "\"");
}

[[noreturn]] void refuse(const std::string& path, const std::string& where,
                         const std::vector<SceneField>& fields) {
  std::vector<std::string> known;
  for (const SceneField& field : fields) {
    for (std::size_t i = 0; i < std::max<std::size_t>(field.size, 1); ++i) {
      known.push_back(field.size == 0 ? field.path : field.path + "[" + std::to_string(i) + "]");
    }
  }
  throw SceneError(where, "\"" + scene::printable(path) + "\"",
                   "the path of a number in the scene; the nearest one is " + nearest(path, known));
}

}  // namespace

SceneNumber find_number(Scene& scene, const scene::Tree& tree, const std::string& asked,
                        const std::string& where) {
  const std::string path = with_index(scene, asked, where);
  std::vector<SceneField> fields = fields_of(scene);
  const std::optional<TreePlace> place = place_of(path);
  if (place && place->size() > 2 && path.rfind(regions, 0) == 0) {
    const std::size_t index = std::get<std::size_t>((*place)[2]);
    std::vector<SceneField> own =
        fields_of(scene.surface.regions[index + scene.surface.image_regions], index);
    if (!own.empty()) fields = std::move(own);
  }
  if (!place || place->empty()) refuse(asked, where, fields);
  for (SceneField& field : fields) {
    for (std::size_t i = 0; i < field.size; ++i) {
      if (path != field.path + "[" + std::to_string(i) + "]") continue;
      if (path == "gravity[2]") field.range = scene::normal_range;
      return {field, i, *place_of(field.path)};
    }
    if (field.size == 0 && path == field.path) return {field, 0, *place};
  }
  const bool is_orientation = path.rfind("initial_state.orientation[", 0) == 0 && place->size() == 3 &&
                              std::holds_alternative<std::size_t>(place->back()) &&
                              std::get<std::size_t>(place->back()) < 4;
  if (!is_orientation && !scene::at_place(tree, *place).as_number()) refuse(asked, where, fields);
  return {std::nullopt, 0, *place};
}

scene::Tree with_number(const scene::Tree& tree, const SceneNumber& number, double value) {
  if (number.field) {
    const SceneField& field = *number.field;
    if (field.size == 0) return scene::with_value(tree, number.place, value);
    scene::Tree::List list(field.data, field.data + field.size);
    const scene::Tree given = scene::at_place(tree, number.place);
    if (const auto items = given.as_list()) {
      list.clear();
      for (const scene::Tree& item : *items) list.push_back(item);
    }
    list[number.index] = value;
    return scene::with_value(tree, number.place, list);
  }
  TreePlace list = number.place;
  list.pop_back();
  scene::Tree base = tree;
  if (scene::at_place(tree, list).is_null()) {  // an orientation that is not given
    base = scene::with_value(tree, list, scene::Tree::List{0.0, 0.0, 0.0, 1.0});
  }
  return scene::with_value(base, number.place, value);
}

std::string unit_of(const scene::Range& range) {
  const std::string text = range.unit;
  const std::size_t begin = text.find('[');
  const std::size_t end = text.find(']');
  return begin == std::string::npos || end == std::string::npos ? ""
                                                                : text.substr(begin + 1, end - begin - 1);
}

}  // namespace hybrid_sphere::study
