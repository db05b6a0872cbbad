#include "python/linearize.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "hybrid_sphere/mechanics/linearization.hpp"
#include "python/model_of_input.hpp"
#include "python/python_function.hpp"
#include "python/system.hpp"
#include "python/unsized_constraint.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::python {
namespace {

namespace py = pybind11;
using mechanics::Index;
using mechanics::Model;
using mechanics::State;

/// hybrid_sphere.Linearization
struct PythonLinearization {
  mechanics::Linearization terms;
  std::vector<std::string> names;
};

/// A field of an item of Solution.at or of Plant.state, or of a dict with the same keys.
template <class Value>
Value state_field(const py::object& state, const std::string& name) {
  std::string fault = "it has no field \"" + name + "\"";
  try {
    const py::object field = state[py::str(name)];
    fault = "field \"" + name + "\"";
    return field.cast<Value>();
  } catch (const py::cast_error&) {
  } catch (py::error_already_set& error) {
    if (!error.matches(PyExc_LookupError) && !error.matches(PyExc_ValueError) &&
        !error.matches(PyExc_TypeError)) {
      throw;
    }
  }
  throw std::invalid_argument(
      text::refusal("state: " + fault, "an item of Solution.at or Plant.run, or Plant.state"));
}

mechanics::Vector state_fields(const py::object& state, const std::vector<std::string>& names) {
  mechanics::Vector values(static_cast<Index>(names.size()));
  for (Index i = 0; i < values.size(); ++i) {
    values[i] = state_field<double>(state, names[static_cast<std::size_t>(i)]);
  }
  return values;
}

/// The parts of "blade;rolling".
std::vector<std::string> parts_of(const py::object& state, const char* field) {
  std::istringstream text(state_field<std::string>(state, field));
  std::vector<std::string> parts;
  for (std::string part; std::getline(text, part, ';');) parts.push_back(part);
  return parts;
}

bool has_constraint(const Model& model, const std::string& name) {
  return std::any_of(model.constraints.begin(), model.constraints.end(),
                     [&name](const mechanics::Constraint& one) { return one.name == name; });
}

/// A slip of two components is opposite to its friction; without friction it has the direction of f.
mechanics::Slide slide_in_plane(const Model& model, std::size_t i, const py::object& state,
                                const State& place) {
  const mechanics::Constraint& constraint = model.constraints[i];
  const std::string column = "lambda_" + constraint.name + "_";
  mechanics::Vector slip = state_fields(state, {column + "1", column + "2"});
  slip = -slip;
  if (slip.isZero(0)) {
    mechanics::Matrix gradient;
    constraint.function->evaluate(place.time, place.q, place.v, slip, gradient);
  }
  return {i, slip};
}

/// "+tyre", "-hub", or "tip" if its slip has two components.
mechanics::Slide slide_of(const Model& model, const std::string& part, const py::object& state,
                          const State& place) {
  const bool is_signed = part[0] == '+' || part[0] == '-';
  if (!is_signed || has_constraint(model, part)) {
    return slide_in_plane(model, model.index_of_constraint(part), state, place);
  }
  return {model.index_of_constraint(part.substr(1)), part[0] == '-' ? -1 : 1};
}

PythonLinearization linearize(const py::object& system, const py::object& given, const py::object& input) {
  const PythonModelOfInput source(system, input);
  const Model& model = source.model();
  PythonLinearization result;
  result.names = model.coordinates;
  result.names.insert(result.names.end(), model.velocities.begin(), model.velocities.end());
  double time = 0;
  try {
    const WhileComputing computing(true);  // with the lock of the interpreter: it is short
    const State state = given_state(model, given);
    time = state.time;
    result.terms = source.has_input() ? mechanics::linearize(source.function(), source.input(), state)
                                      : mechanics::linearize(model, state);
  } catch (const NumericalError& error) {
    raise_halted(error, time);
  }
  return result;
}

std::string describe_linearization(const PythonLinearization& self) {
  std::string text = "<hybrid_sphere.Linearization of";
  for (const std::string& name : self.names) text += " " + name;
  const Index inputs = self.terms.B.cols();
  return text + "; " + std::to_string(inputs) + (inputs == 1 ? " input>" : " inputs>");
}

py::array matrix_of(const mechanics::Matrix& matrix) {
  const auto column = static_cast<py::ssize_t>(sizeof(double)) * matrix.rows();
  return py::array_t<double>({matrix.rows(), matrix.cols()}, {py::ssize_t{sizeof(double)}, column},
                             matrix.data());
}

constexpr const char* linearize_doc =
    R"(The equations of motion near a state, under the constraints that hold there: with x = (q, v),
x' = rate + A dx + B du. Off the constraints they are these, differentiated once, so that A has an eigenvalue 0 for each
constraint besides those of the motion.

system  a Model, or a function of the input that returns one, as of Plant
state   an item of what Solution.at returns, or Plant.state, of the same system
input   as of Plant: None, without B; True: generalised forces, at 0; or numbers, at these

Returns a Linearization. Derivatives are good to some 1e-11 of the sizes of their terms where forces are smooth.

Raises ValueError for a state of another system, Halted where the equations have no solution or are not finite, and
whatever a function of the system raises.)";

}  // namespace

State given_state(const Model& model, const py::object& given) {
  State state;
  state.time = state_field<double>(given, "t");
  state.q = state_fields(given, model.coordinates);
  state.v = state_fields(given, model.velocities);
  find_sizes(model, {state.time, state.q, state.v});
  for (const std::string& name : parts_of(given, "active")) {
    state.active.push_back(model.index_of_constraint(name));
  }
  for (const std::string& part : parts_of(given, "sliding")) {
    state.sliding.push_back(slide_of(model, part, given, state));
  }
  return state;
}

void declare_linearize(py::module_& module) {
  py::class_<PythonLinearization>(module, "Linearization", "What linearize returns: x' = rate + A dx + B du.")
      .def("__repr__", describe_linearization)
      .def_property_readonly(
          "rate", [](const PythonLinearization& self) { return floats(self.terms.rate); },
          "x' at the state, (N + n,).")
      .def_property_readonly(
          "A", [](const PythonLinearization& self) { return matrix_of(self.terms.A); },
          "dx'/dx, (N + n, N + n).")
      .def_property_readonly(
          "B", [](const PythonLinearization& self) { return matrix_of(self.terms.B); },
          "dx'/du, (N + n, m); m = 0 without an input.")
      .def_property_readonly(
          "names", [](const PythonLinearization& self) { return py::tuple(py::cast(self.names)); },
          "Of x: the coordinates and the velocities, a tuple.");
  module.def("linearize", linearize, py::arg("system"), py::arg("state"), py::arg("input") = py::none(),
             linearize_doc);
}

}  // namespace hybrid_sphere::python
