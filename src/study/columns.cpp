#include "study/columns.hpp"

#include <utility>

#include "hybrid_sphere/simulation/records.hpp"
#include "scene/scene_number.hpp"

namespace hybrid_sphere::study {
namespace {

using Type = Column::Type;

/// Of an enumeration from 0, or from a name for what has none, up to the last one.
template <class Code>
std::vector<std::string> names_up_to(Code last) {
  std::vector<std::string> names;
  for (int i = 0; i <= static_cast<int>(last); ++i) names.emplace_back(to_string(static_cast<Code>(i)));
  return names;
}

std::vector<std::string> names_of_regions(const scene::Scene& scene) {
  std::vector<std::string> names{scene::base_name};
  for (const scene::Region& region : scene.surface.regions) names.push_back(region.name);
  return names;
}

std::vector<std::string> names_of_stages() { return {"", "holonomic", "", "nonholonomic"}; }

Column column_of(StateField field, const scene::Scene& scene) {
  const std::string name = to_string(field);
  switch (field) {
    case StateField::position: return {name, {2}, "m", Type::real, {}, "of the centre"};
    case StateField::velocity: return {name, {2}, "m/s", Type::real, {}, "of the centre"};
    case StateField::angular_velocity: return {name, {3}, "rad/s", Type::real, {}, "on the fixed axes"};
    case StateField::orientation:
      return {name, {4}, "", Type::real, {}, "quaternion x, y, z, w, body to world"};
    case StateField::slip: return {name, {2}, "m/s", Type::real, {}, "of the contact point on the ground"};
    case StateField::energy: return {name, {}, "J", Type::real, {}, "kinetic"};
    case StateField::stage: return {name, {}, "", Type::code, names_of_stages(), "of the hybrid system"};
    case StateField::mode: return {name, {}, "", Type::code, names_up_to(Mode::resting), "of the motion"};
    case StateField::region: return {name, {}, "", Type::code, names_of_regions(scene), "under the sphere"};
  }
  return {};
}

Column column_of(Extreme extreme) {
  const std::string name = std::string("extremes/") + to_string(extreme);
  switch (extreme) {
    case Extreme::speed: return {name, {}, "m/s", Type::real, {}, "the greatest of the centre"};
    case Extreme::spin: return {name, {}, "rad/s", Type::real, {}, "the greatest angular velocity"};
    case Extreme::slip:
      return {name, {}, "m/s", Type::real, {}, "the greatest of the contact point on the ground"};
    case Extreme::energy_lost: return {name, {}, "J", Type::real, {}, "by the impulses of all switches"};
  }
  return {};
}

/// A name in the file, where slashes are between groups: another one for each path.
std::string without_slashes(const std::string& path) {
  std::string name;
  for (const char c : path) name += c == '/' ? "%2F" : c == '%' ? "%25" : std::string(1, c);
  return name;
}

void add_samples(const Study& study, scene::Scene scene, std::vector<Column>& columns) {
  for (const Variable& variable : study.variables) {
    const scene::SceneNumber number =
        scene::find_number(scene, study.scene_tree, variable.path, "vary." + variable.path);
    const std::string unit = number.field ? scene::unit_of(number.field->range) : "";
    columns.push_back({"samples/" + without_slashes(variable.path), {}, unit, Type::real, {}, "as drawn"});
  }
}

void add_switches(const Keep& keep, std::vector<Column>& columns) {
  if (!keep.switches) return;
  const std::uint64_t first = *keep.switches;
  columns.push_back({"switches/count", {}, "", Type::code, {}, "how many there were"});
  if (first == 0) return;
  const std::vector<std::string> kinds{"", "applied", "released", "exchanged"};
  columns.push_back({"switches/time", {first}, "s", Type::real, {}, "of the first ones"});
  columns.push_back({"switches/kind", {first}, "", Type::code, kinds, "of the first ones"});
  columns.push_back(
      {"switches/cause", {first}, "", Type::code, names_up_to(Cause::accumulation), "of the first ones"});
  columns.push_back({"switches/impulse", {first, 2}, "N s", Type::real, {}, "of the ground on the sphere"});
}

}  // namespace

Columns columns_of(const Study& study, const scene::Scene& scene) {
  Columns columns;
  std::vector<Column>& all = columns.all;
  add_samples(study, scene, all);
  columns.outcome = all.size();
  all.push_back({"outcome", {}, "", Type::code, {"done", "halted", "refused"}, "how the run ended"});
  columns.stop = all.size();
  all.push_back({"stop", {}, "", Type::code, names_up_to(Stop::interrupted), "why it could not go on"});
  columns.stopped_at = all.size();
  all.push_back({"stopped_at", {}, "s", Type::real, {}, "when it could not go on"});
  columns.end = all.size();
  for (const StateField field : study.keep.end) {
    all.push_back(column_of(field, scene));
    all.back().name.insert(0, "end/");
  }
  columns.at = all.size();
  for (const StateField field : study.keep.at) {
    Column column = column_of(field, scene);
    column.name.insert(0, "at/");
    column.shape.insert(column.shape.begin(), study.keep.times.size());
    all.push_back(std::move(column));
  }
  columns.switches = all.size();
  add_switches(study.keep, all);
  columns.entered = all.size();
  if (!study.keep.entered.empty()) {
    all.push_back({"entered",
                   {study.keep.entered.size()},
                   "s",
                   Type::real,
                   {},
                   "when each of the regions was first entered; missing: never"});
  }
  columns.extremes = all.size();
  for (const Extreme extreme : study.keep.extremes) all.push_back(column_of(extreme));
  return columns;
}

const char* to_string(StateField field) {
  switch (field) {
    case StateField::position: return "position";
    case StateField::velocity: return "velocity";
    case StateField::angular_velocity: return "angular_velocity";
    case StateField::orientation: return "orientation";
    case StateField::slip: return "slip";
    case StateField::energy: return "energy";
    case StateField::stage: return "stage";
    case StateField::mode: return "mode";
    case StateField::region: return "region";
  }
  return "";
}

const char* to_string(Extreme extreme) {
  switch (extreme) {
    case Extreme::speed: return "speed";
    case Extreme::spin: return "spin";
    case Extreme::slip: return "slip";
    case Extreme::energy_lost: return "energy_lost";
  }
  return "";
}

}  // namespace hybrid_sphere::study
