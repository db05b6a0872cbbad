#include "python/modes.hpp"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "hybrid_sphere/mechanics/equilibrium.hpp"
#include "hybrid_sphere/mechanics/modes.hpp"
#include "python/linearize.hpp"
#include "python/model_of_input.hpp"
#include "python/motion_arrays.hpp"
#include "python/python_function.hpp"
#include "python/system.hpp"

namespace hybrid_sphere::python {
namespace {

namespace py = pybind11;

/// hybrid_sphere.Modes
struct PythonModes {
  mechanics::Modes terms;
  std::vector<std::string> names;
};

py::object equilibrium(const py::object& system, const py::object& q, const py::object& v,
                       std::optional<double> t, const py::object& input) {
  const PythonModelOfInput source(system, input);
  mechanics::Model model = source.model();
  MotionRequest request;
  request.q = q;
  request.v = v.is_none() && !q.is_none()
                  ? py::object(floats(mechanics::Vector::Zero(mechanics::Index(model.velocities.size()))))
                  : v;
  request.t = t;
  const mechanics::Initial guess = start_of(source.initial(), model, request);
  if (source.has_input()) model = source.function()(source.input());
  MotionTable states = state_table(model);
  try {
    const WhileComputing computing(true);  // with the lock of the interpreter: it is short
    add(model, mechanics::equilibrium(model, guess), states);
  } catch (const NumericalError& error) {
    raise_halted(error, guess.time);
  }
  return states.array()[py::int_(0)];
}

PythonModes modes(const py::object& system, const py::object& given, const py::object& input) {
  const PythonModelOfInput source(system, input);
  PythonModes result;
  result.names = source.model().coordinates;
  result.names.insert(result.names.end(), source.model().velocities.begin(), source.model().velocities.end());
  double time = 0;
  try {
    const WhileComputing computing(true);
    const mechanics::State state = given_state(source.model(), given);
    time = state.time;
    result.terms =
        mechanics::modes(source.has_input() ? source.function()(source.input()) : source.model(), state);
  } catch (const NumericalError& error) {
    raise_halted(error, time);
  }
  return result;
}

std::string describe_modes(const PythonModes& self) {
  return "<hybrid_sphere.Modes: " + std::to_string(self.terms.eigenvalues.size()) + " eigenvalues, " +
         std::to_string(self.terms.neutral) + " neutral directions>";
}

constexpr const char* equilibrium_doc =
    R"(A state near a guess at which the accelerations under the constraints that hold are 0.

Newton's method with a line search moves positions in directions that the constraints leave free. Velocities of the guess
are kept, if the constraints allow: with those of cyclic coordinates the result is a steady motion.

system  a Model, or a function of the input that returns one, as of Plant
q, v    the guess; v = None: at rest
t       the time [s]; None: 0, or that of the catalogue
input   as of Plant

Returns the state, as Plant.state.

Raises ValueError for a guess of another size, and Halted, with the residual, if the method does not converge, or if a
contact would lift off or a friction slide there.)";

constexpr const char* modes_doc =
    R"(Eigenvalues of small motions about a state of rest or of a steady motion, in all directions that the constraints leave
free.

system  a Model, or a function of the input that returns one, as of Plant
state   as of linearize, for example what equilibrium returns
input   as of linearize

Returns Modes. Directions whose eigenvalue is 0, below about 1e-4 of the largest one, are left out and counted.

Raises ValueError for a state that is not steady; otherwise as linearize.)";

}  // namespace

void declare_modes(py::module_& module) {
  py::class_<PythonModes>(module, "Modes", "What modes returns.")
      .def("__repr__", describe_modes)
      .def_property_readonly(
          "eigenvalues", [](const PythonModes& self) { return self.terms.eigenvalues; },
          "By descending real part, complex, (k,) [1/s].")
      .def_property_readonly(
          "vectors", [](const PythonModes& self) { return self.terms.vectors; },
          "The change of x = (q, v) in each mode, of length 1, complex, (N + n, k).")
      .def_property_readonly(
          "neutral", [](const PythonModes& self) { return self.terms.neutral; },
          "How many directions have the eigenvalue 0: along cyclic coordinates, and to other steady motions.")
      .def_property_readonly(
          "names", [](const PythonModes& self) { return py::tuple(py::cast(self.names)); },
          "Of x: the coordinates and the velocities, a tuple.");
  module.def("equilibrium", equilibrium, py::arg("system"), py::arg("q") = py::none(),
             py::arg("v") = py::none(), py::kw_only(), py::arg("t") = py::none(),
             py::arg("input") = py::none(), equilibrium_doc);
  module.def("modes", modes, py::arg("system"), py::arg("state"), py::arg("input") = py::none(), modes_doc);
}

}  // namespace hybrid_sphere::python
