#include "python/motion_arrays.hpp"

#include <set>
#include <stdexcept>

#include "python/numpy_text.hpp"

namespace hybrid_sphere::python {
namespace {

using mechanics::Index;
using mechanics::Model;
using mechanics::Vector;
using Kind = MotionTable::Kind;
using Columns = std::vector<MotionTable::Column>;

void put_names(const std::vector<std::string>& names, const std::string& prefix, const std::string& suffix,
               Columns& columns) {
  for (const std::string& name : names) columns.push_back({prefix + name + suffix});
}

std::string component(const std::string& name, Index i) { return name + "_" + std::to_string(i); }

/// "lambda_rolling", or "lambda_rolling_1", ... if a constraint has several functions. Refuses the name of a
/// constraint that would be the next one of those.
void put_multipliers(const Model& model, const std::string& prefix, Columns& columns) {
  std::set<std::string> next;
  for (const mechanics::Constraint& constraint : model.constraints) {
    const Index size = constraint.function->size();
    if (size > 1) next.insert(component(prefix + constraint.name, size + 1));
  }
  for (const mechanics::Constraint& constraint : model.constraints) {
    const std::string name = prefix + constraint.name;
    const Index size = constraint.function->size();
    if (size == 1 && next.count(name) > 0) {
      throw std::invalid_argument("the column \"" + name +
                                  "\" would belong to another constraint: give constraint " +
                                  constraint.name + " another name");
    }
    for (Index i = 1; i <= size; ++i) columns.push_back({size > 1 ? component(name, i) : name});
  }
}

/// Characters of all names, each with a sign and behind a semicolon.
template <class Named>
std::size_t width_of(const std::vector<Named>& all) {
  std::size_t width = 1;
  for (const Named& one : all) width += numpy_text(one.name).size() + 2;
  return width;
}

void add(const Vector& values, MotionTable& table) {
  for (const double value : values) table.add_number(value);
}

/// Put behind others, separated by a semicolon.
void append(const std::string& name, std::string& text) { text += (text.empty() ? "" : ";") + name; }

/// "blade;rolling"
std::string joined(const Model& model, const mechanics::ActiveSet& set) {
  std::string text;
  for (const std::size_t i : set) append(model.constraints[i].name, text);
  return text;
}

/// "+tyre;-hub;tip": with the signs of slip velocities of one component.
std::string joined(const Model& model, const mechanics::Slides& slides) {
  std::string text;
  for (const mechanics::Slide& slide : slides) {
    const std::string sign = slide.direction == 0 ? "" : slide.direction > 0 ? "+" : "-";
    append(sign + model.constraints[slide.constraint].name, text);
  }
  return text;
}

std::string joined_events(const Model& model, const std::vector<std::size_t>& events) {
  std::string text;
  for (const std::size_t i : events) append(model.events[i].name, text);
  return text;
}

}  // namespace

MotionTable state_table(const Model& model) {
  Columns columns{{"t"}, {"stage", Kind::byte}};
  put_names(model.coordinates, "", "", columns);
  put_names(model.velocities, "", "", columns);
  put_multipliers(model, "lambda_", columns);
  put_names({"energy", "kinetic_energy", "residual", "estimated_error"}, "", "", columns);
  const std::size_t width = width_of(model.constraints);
  for (const char* name : {"active", "sliding", "penetrating"}) {
    columns.push_back({name, Kind::text, width});
  }
  return {columns, "the states"};
}

void add(const Model& model, const mechanics::State& state, MotionTable& table) {
  table.add_number(state.time);
  table.add_whole(static_cast<std::uint64_t>(state.stage));
  add(state.q, table);
  add(state.v, table);
  add(state.multipliers, table);
  table.add_number(state.energy);
  table.add_number(state.kinetic_energy);
  table.add_number(state.residual);
  table.add_number(state.estimated_error);
  table.add_text(joined(model, state.active));
  table.add_text(joined(model, state.sliding));
  table.add_text(joined(model, state.penetrating));
}

MotionTable switch_table(const Model& model) {
  const std::size_t width = width_of(model.constraints);
  Columns columns{
      {"index", Kind::count}, {"t"}, {"applied", Kind::text, width}, {"released", Kind::text, width}};
  put_names(model.coordinates, "", "", columns);
  put_names(model.velocities, "", "_before", columns);
  put_names(model.velocities, "", "_after", columns);
  put_multipliers(model, "Lambda_", columns);
  put_names(model.velocities, "P_", "", columns);
  columns.push_back({"rank", Kind::count});
  put_names({"energy_before", "energy_after", "kinetic_energy_before", "kinetic_energy_after"}, "", "",
            columns);
  columns.push_back({"active", Kind::text, width});
  columns.push_back({"sliding", Kind::text, width});
  columns.push_back({"events", Kind::text, width_of(model.events)});
  return {columns, "the switches"};
}

void add(const Model& model, const mechanics::Switch& event, MotionTable& table) {
  table.add_whole(event.index);
  table.add_number(event.time);
  table.add_text(joined(model, event.applied));
  table.add_text(joined(model, event.released));
  for (const Vector* values :
       {&event.q, &event.v_before, &event.v_after, &event.multipliers, &event.impulse}) {
    add(*values, table);
  }
  table.add_whole(static_cast<std::uint64_t>(event.rank));
  for (const double energy :
       {event.energy_before, event.energy_after, event.kinetic_energy_before, event.kinetic_energy_after}) {
    table.add_number(energy);
  }
  table.add_text(joined(model, event.active));
  table.add_text(joined(model, event.sliding));
  table.add_text(joined_events(model, event.events));
}

}  // namespace hybrid_sphere::python
