#include "python/system.hpp"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <memory>
#include <stdexcept>

#include "python/catalogue.hpp"
#include "python/solution.hpp"
#include "python/system_functions.hpp"

namespace hybrid_sphere::python {
namespace {

namespace py = pybind11;

std::unique_ptr<PythonSolution> solve(const PythonModel& system, const std::optional<double>& duration,
                                      const py::object& q, const py::object& v,
                                      const std::optional<double>& t, double accuracy, bool project,
                                      bool project_positions, const std::optional<double>& max_step) {
  if (!duration && !system.duration) throw std::invalid_argument("the duration is missing");
  return std::make_unique<PythonSolution>(
      system, duration ? *duration : *system.duration,
      MotionRequest{q, v, t, accuracy, project, project_positions, max_step});
}

py::tuple names_of(const std::vector<std::string>& names) { return py::tuple(py::cast(names)); }

template <class Named>
py::tuple names_of(const std::vector<Named>& all) {
  py::tuple names(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) names[i] = all[i].name;
  return names;
}

py::dict parameters_of(const PythonSystem& system) {
  py::dict result;
  for (const auto& [name, value] : system.parameters) result[py::str(name)] = value;
  return result;
}

/// The initial state of the catalogue, or None.
py::object initial(const PythonSystem& system, const mechanics::Vector mechanics::Initial::*numbers) {
  if (!system.initial) return py::none();
  const Eigen::VectorXd copy = (*system.initial).*numbers;
  return py::cast(copy);
}

/// "<hybrid_sphere.System knife_edge of x y theta; blade>" @param kind  "System knife_edge"
std::string describe(const std::string& kind, const mechanics::Model& model) {
  std::string text = "<hybrid_sphere." + kind + " of";
  for (const std::string& name : model.coordinates) text += " " + name;
  for (const mechanics::Constraint& constraint : model.constraints) {
    text += (&constraint == &model.constraints.front() ? "; " : ", ") + constraint.name;
  }
  return text + ">";
}

constexpr const char* solve_doc =
    R"(Computes a motion: free, an impulse at each change of the constraints, under constraints.

duration  [s]; None: that of the catalogue
q, v      where it starts, (N,) and (n,); None: as in the catalogue
t         when it starts [s]; None: as in the catalogue, or 0
accuracy  wanted error of q and v, relative to the scale of the motion, 1e-13 to 0.1
project   True: initial velocities that violate a constraint that holds from the start are put onto it, not refused
project_positions  True: initial positions that are off a holonomic constraint that holds from the start, such as
          rounded ones, are put onto it, not refused, by the smallest change in the metric of the mass matrix
max_step  longest step [s], for forces and guards that act only for a short time; None: as the accuracy allows

Returns a Solution. A motion that cannot go on ends early, and Solution.reason says why.

Raises ValueError for numbers that are refused, and whatever a function of the system raises.)";

constexpr const char* catalogue_doc = R"(A classical system, with its initial state.

name        one of systems()
parameters  its numbers by name, constants and initial values; `three_stage explain NAME` has what they mean

Returns a System. Raises SceneError, with key, value and allowed.)";

void declare_model(py::class_<PythonModel>& type) {
  type.def("__repr__",
           [](const py::object& self) {
             const std::string kind = py::type::of(self).attr("__name__").cast<std::string>();
             return describe(kind, *self.cast<const PythonModel&>().model);
           })
      .def_property_readonly(
          "coordinates", [](const PythonModel& s) { return names_of(s.model->coordinates); },
          "Names of q, a tuple.")
      .def_property_readonly(
          "velocities", [](const PythonModel& s) { return names_of(s.model->velocities); },
          "Names of v, a tuple.")
      .def_property_readonly(
          "constraints", [](const PythonModel& s) { return names_of(s.model->constraints); },
          "Names of the constraints, a tuple.")
      .def_property_readonly(
          "events", [](const PythonModel& s) { return names_of(s.model->events); },
          "Names of the events, a tuple.")
      .def("solve", solve, py::arg("duration") = py::none(), py::arg("q") = py::none(),
           py::arg("v") = py::none(), py::kw_only(), py::arg("t") = py::none(),
           py::arg("accuracy") = mechanics::Options().accuracy, py::arg("project") = false,
           py::arg("project_positions") = false, py::arg("max_step") = py::none(), solve_doc);
}

void declare_attributes(py::class_<PythonSystem, PythonModel>& type) {
  type.def("__repr__",
           [](const PythonSystem& system) {
             return describe(system.name.empty() ? "System" : "System " + system.name, *system.model);
           })
      .def_readonly("name", &PythonSystem::name, "In the catalogue; empty elsewhere, as the other texts.")
      .def_readonly("title", &PythonSystem::title, "One line.")
      .def_readonly("description", &PythonSystem::description,
                    "A page: coordinates, L, Q, f and when it holds, what to watch for, the known solution, "
                    "the source.")
      .def_property_readonly("parameters", parameters_of, "Its numbers, a dict name -> float.")
      .def_property_readonly(
          "duration", [](const PythonSystem& s) { return s.duration; },
          "As a rule [s]; None where the system is not of the catalogue.")
      .def_property_readonly(
          "q", [](const PythonSystem& s) { return initial(s, &mechanics::Initial::q); },
          "Where it starts as a rule, (N,), or None.")
      .def_property_readonly(
          "v", [](const PythonSystem& s) { return initial(s, &mechanics::Initial::v); },
          "How it starts as a rule, (n,), or None.");
}

}  // namespace

void declare_system(py::module_& module) {
  py::class_<PythonModel> model(module, "Model", "What a System and a MultibodySystem have in common.",
                                collected<PythonModel>());
  declare_model(model);
  declare_event(model);
  py::class_<PythonSystem, PythonModel> type(
      module, "System", "A hybrid Lagrangian system: of the catalogue, or from functions.",
      collected<PythonSystem>());
  declare_functions(type);
  declare_attributes(type);
  module.def("systems", catalogue_names, "The names of the catalogue, a tuple of str.");
  module.def("catalogue", of_catalogue, py::arg("name"), py::pos_only(), catalogue_doc);
}

}  // namespace hybrid_sphere::python
