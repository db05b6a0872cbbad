#include "scene/scene_number.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>
#include <variant>

#include "scene/printable.hpp"
#include "text/nearest.hpp"

namespace hybrid_sphere::scene {
namespace {

template <class Vector>
SceneField list(const std::string& path, Vector& numbers, const Range& range) {
  return {path, numbers.data(), static_cast<std::size_t>(numbers.size()), range};
}

SceneField number(const std::string& path, double& value, const Range& range) {
  return {path, &value, 0, range};
}

SceneField bounded_by_sphere(SceneField field) {
  field.is_bounded_by_sphere = true;
  return field;
}

/// Those that the law has.
void add_material(Material& material, const std::string& path, std::vector<SceneField>& fields) {
  if (material.law == Law::smooth) return;
  if (material.law == Law::coulomb) {
    fields.push_back(number(path + ".friction", material.friction, coefficient_range));
  }
  fields.push_back(number(path + ".rolling_resistance", material.rolling_resistance, coefficient_range));
  if (material.law != Law::rubber) {
    fields.push_back(number(path + ".spin_friction", material.spin_friction, coefficient_range));
  }
  if (material.turntable_rate != 0) {
    fields.push_back(number(path + ".turntable.rate", material.turntable_rate, rate_range));
    fields.push_back(list(path + ".turntable.center", material.turntable_center, coordinate_range));
  } else {
    fields.push_back(list(path + ".belt", material.belt, belt_range));
  }
}

void add_shape(Shape& shape, const std::string& path, std::vector<SceneField>& fields) {
  if (auto* half_plane = std::get_if<HalfPlane>(&shape)) {
    fields.push_back(list(path + ".half_plane.point", half_plane->point, coordinate_range));
    fields.push_back(list(path + ".half_plane.normal", half_plane->normal, edge_normal_range));
  } else if (auto* circle = std::get_if<Circle>(&shape)) {
    fields.push_back(list(path + ".circle.center", circle->center, coordinate_range));
    fields.push_back(number(path + ".circle.radius", circle->radius, circle_radius_range));
  }
}

/// All but those of regions.
std::vector<SceneField> fields_of(Scene& scene) {
  SphereBody& body = scene.sphere;
  InitialState& start = scene.initial_state;
  Forces& forces = scene.forces;
  std::vector<SceneField> fields = {
      number("sphere.mass", body.mass, mass_range),
      number("sphere.radius", body.radius, radius_range),
      bounded_by_sphere(number("sphere.gyration_radius", body.gyration_radius, gyration_range(body.radius))),
      list("initial_state.position", start.position, coordinate_range),
      list("initial_state.velocity", start.velocity, velocity_range),
      list("initial_state.angular_velocity", start.angular_velocity, spin_range),
      list("gravity", forces.gravity, in_plane_range),
      bounded_by_sphere(list("wrench.force", forces.wrench.force, force_range(body))),
      bounded_by_sphere(list("wrench.torque", forces.wrench.torque, torque_range(body))),
      bounded_by_sphere(
          number("drag.translational", forces.drag.translational, translational_drag_range(body))),
      bounded_by_sphere(number("drag.rotational", forces.drag.rotational, rotational_drag_range(body))),
      bounded_by_sphere(number("drag.quadratic", forces.drag.quadratic, quadratic_drag_range(body))),
      bounded_by_sphere(number("spring.stiffness", forces.spring.stiffness, stiffness_range(body))),
      list("spring.center", forces.spring.center, coordinate_range),
      number("solver.accuracy", scene.solver.accuracy, accuracy_range),
      number("solver.step", scene.solver.step, step_range),
  };
  add_material(scene.surface.base, "surface.base", fields);
  return fields;
}

std::vector<SceneField> fields_of(Region& region, std::size_t index) {
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
  throw SceneError(where, "region \"" + printable(name) + "\"",
                   names.empty() ? "a scene with regions that have names"
                                 : "the name of a region of the scene; the nearest one is \"" +
                                       text::nearest(name, names) + "\"");
}

[[noreturn]] void refuse(const std::string& path, const std::string& where,
                         const std::vector<SceneField>& fields) {
  std::vector<std::string> known;
  for (const SceneField& field : fields) {
    for (std::size_t i = 0; i < std::max<std::size_t>(field.size, 1); ++i) {
      known.push_back(field.size == 0 ? field.path : field.path + "[" + std::to_string(i) + "]");
    }
  }
  throw SceneError(where, "\"" + printable(path) + "\"",
                   "the path of a number in the scene; the nearest one is " + text::nearest(path, known));
}

}  // namespace

SceneNumber find_number(Scene& scene, const Tree& tree, const std::string& asked, const std::string& where) {
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
      if (path == "gravity[2]") field.range = normal_range;
      return {field, i, *place_of(field.path)};
    }
    if (field.size == 0 && path == field.path) return {field, 0, *place};
  }
  const bool is_orientation = path.rfind("initial_state.orientation[", 0) == 0 && place->size() == 3 &&
                              std::holds_alternative<std::size_t>(place->back()) &&
                              std::get<std::size_t>(place->back()) < 4;
  if (!is_orientation && !at_place(tree, *place).as_number()) refuse(asked, where, fields);
  return {std::nullopt, 0, *place};
}

Tree with_number(const Tree& tree, const SceneNumber& number, double value) {
  if (number.field) {
    const SceneField& field = *number.field;
    if (field.size == 0) return with_value(tree, number.place, value);
    Tree::List list(field.data, field.data + field.size);
    const Tree given = at_place(tree, number.place);
    if (const auto items = given.as_list()) {
      list.clear();
      for (const Tree& item : *items) list.push_back(item);
    }
    list[number.index] = value;
    return with_value(tree, number.place, list);
  }
  TreePlace list = number.place;
  list.pop_back();
  Tree base = tree;
  if (at_place(tree, list).is_null()) {  // an orientation that is not given
    base = with_value(tree, list, Tree::List{0.0, 0.0, 0.0, 1.0});
  }
  return with_value(base, number.place, value);
}

std::string unit_of(const Range& range) {
  const std::string text = range.unit;
  const std::size_t begin = text.find('[');
  const std::size_t end = text.find(']');
  return begin == std::string::npos || end == std::string::npos ? ""
                                                                : text.substr(begin + 1, end - begin - 1);
}

}  // namespace hybrid_sphere::scene
