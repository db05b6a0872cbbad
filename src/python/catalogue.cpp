#include "python/catalogue.hpp"

#include <algorithm>
#include <stdexcept>

#include "catalogue/catalogue.hpp"
#include "hybrid_sphere/scene/scene_error.hpp"
#include "python/numbers_of.hpp"
#include "scene/printable.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::python {
namespace {

namespace py = pybind11;
namespace catalogue = mechanics::catalogue;
using scene::SceneError;

template <class Named>
std::string list(const std::vector<Named>& all) {
  std::string names;
  for (const Named& one : all) names += (names.empty() ? "" : ", ") + one.name;
  return names;
}

template <class Named>
const Named* find(const std::vector<Named>& all, const std::string& name) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Named& one) { return one.name == name; });
  return found == all.end() ? nullptr : &*found;
}

double number_of(const catalogue::Parameter& parameter, const py::handle& object) {
  const std::string allowed = "a number from " + text::shortest(parameter.low) + " to " +
                              text::shortest(parameter.high) + ", " + parameter.meaning;
  const double value = PyFloat_AsDouble(object.ptr());
  if (PyErr_Occurred() != nullptr) {
    forget_wrong_kind();
    throw SceneError(parameter.name, scene::printable(py::repr(object).cast<std::string>()), allowed);
  }
  if (!(value >= parameter.low && value <= parameter.high)) {
    throw SceneError(parameter.name, text::shortest(value), allowed);
  }
  return value;
}

}  // namespace

py::tuple catalogue_names() {
  const std::vector<catalogue::Entry>& entries = catalogue::entries();
  py::tuple names(entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i) names[i] = entries[i].name;
  return names;
}

PythonSystem of_catalogue(const std::string& name, const py::kwargs& parameters) {
  const catalogue::Entry* const entry = find(catalogue::entries(), name);
  if (entry == nullptr) {
    throw SceneError("name", "\"" + scene::printable(name) + "\"", list(catalogue::entries()));
  }
  catalogue::Values values(entry->parameters);
  for (const auto& [key, value] : parameters) {
    const std::string key_text = key.cast<std::string>();
    const catalogue::Parameter* const parameter = find(entry->parameters, key_text);
    if (parameter == nullptr) {
      throw SceneError(scene::printable(key_text), scene::printable(py::repr(value).cast<std::string>()),
                       "the parameters of " + name + ": " + list(entry->parameters));
    }
    values.set(key_text, number_of(*parameter, value));
  }
  PythonSystem system;
  try {
    const catalogue::Example example = entry->build(values);
    *system.model = example.model;
    system.initial = example.initial;
  } catch (const std::invalid_argument& error) {  // numbers that do not fit together
    throw SceneError(error.what());
  }
  system.name = name;
  system.title = entry->title;
  system.description = entry->description;
  system.duration = entry->duration;
  for (const catalogue::Parameter& parameter : entry->parameters) {
    system.parameters.emplace_back(parameter.name, values[parameter.name]);
  }
  return system;
}

}  // namespace hybrid_sphere::python
