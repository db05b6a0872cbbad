#include "python/solution.hpp"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <stdexcept>

#include "python/numbers_of.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::python {
namespace {

namespace py = pybind11;

mechanics::Solution motion_of(const PythonModel& system, const mechanics::Model& model, double duration,
                              const MotionRequest& request) {
  const mechanics::Initial initial = start_of(system.initial, model, request);
  state_table(model);  // refuses names before the motion is computed
  switch_table(model);
  Signals signals;
  const mechanics::Options options = options_of(request, signals);
  const auto computed = [&] {
    const WhileComputing computing(system.calls_python());
    return mechanics::solve(model, initial, duration, options);
  };
  mechanics::Solution motion = computed();
  if (motion.status().stop == mechanics::Stop::cancelled) signals.rethrow();
  return motion;
}

constexpr const char* solution_doc = R"(A motion, as a function of the time: what System.solve returns.

In the arrays, the names of coordinates, velocities and constraints stand for the columns, as in the tables that
three_stage writes. Fields are attributes, too: motion.at(2).x)";

constexpr const char* at_doc = R"(The states at some times.

times  (n,), in any order, or one number, from begin to end [s]

Returns a structured array (n,), or one item of it, with the fields t, stage, <coordinates>, <velocities>,
lambda_<constraint> (lambda_<constraint>_1, ... where it has several functions), energy, kinetic_energy, residual,
estimated_error, that of the solution up to this time, and the texts active, the constraints that hold
("blade;rolling"), sliding, those with friction that slide, with the sign of the slip velocity ("+tyre"), and
penetrating, the contacts whose gap is negative by more than its error: a step has missed that they close, and
max_step should be shorter. At the time of a switch it is the state after it.

Raises ValueError for other times, Halted where the equations have no solution at one of them.)";

constexpr const char* solution_switches_doc =
    R"(The switches: a structured array with the fields index, t, applied, released
("blade;rolling"), <coordinates>, <velocities>_before, <velocities>_after, Lambda_<constraint>, P_<velocity>, rank,
energy_before, energy_after, kinetic_energy_before, kinetic_energy_after, and the texts active and sliding, as in a
state afterwards, and events.)";

}  // namespace

PythonSolution::PythonSolution(const PythonModel& system, double duration, const MotionRequest& request)
    : functions_(system.kept),
      model_(*system.model),
      motion_(motion_of(system, model_, duration, request)),
      states_(state_table(model_)) {}

py::object PythonSolution::let_go() {
  if (functions_.list()) in_use_.take();
  return functions_.let_go();
}

void PythonSolution::check_times(const std::vector<double>& times) const {
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (times[i] >= motion_.begin() && times[i] <= motion_.end()) continue;
    throw py::value_error(text::refusal("times[" + std::to_string(i) + "]: " + text::shortest(times[i]),
                                        text::shortest(motion_.begin()) + " to " +
                                            text::shortest(motion_.end()) + " [s], the end of the motion (" +
                                            mechanics::to_string(motion_.status().stop) + ")"));
  }
}

py::object PythonSolution::at(const py::object& given) {
  const ExclusiveUse use(in_use_);
  const Numbers times = numbers_of(given, "times");
  std::vector<double> all;
  if (times.ndim() == 0) {
    all.push_back(*times.data());
  } else {
    const mechanics::Vector numbers = vector_of(times, "times");
    all.assign(numbers.begin(), numbers.end());
  }
  check_times(all);
  states_.clear();
  Signals signals;
  double now = 0;
  bool is_ended = false;
  try {
    const WhileComputing computing(static_cast<bool>(functions_.list()));
    for (const double time : all) {
      if ((is_ended = signals.have_come())) break;
      add(model_, motion_.at(now = time), states_);
    }
  } catch (const NumericalError& error) {
    raise_halted(error, now);
  }
  if (is_ended) signals.rethrow();
  py::array states = states_.array();
  if (times.ndim() == 0) return states[py::int_(0)];
  return std::move(states);
}

py::array PythonSolution::switches() {
  const ExclusiveUse use(in_use_);
  MotionTable table = switch_table(model_);
  for (const mechanics::Switch& event : motion_.switches()) add(model_, event, table);
  return table.array();
}

py::dict PythonSolution::constraints() const {
  py::dict result;
  for (const mechanics::ConstraintReport& report : motion_.constraints()) {
    result[py::str(report.name)] = py::make_tuple(report.applied, report.held);
  }
  return result;
}

std::string PythonSolution::describe() const {
  const std::size_t count = motion_.switches().size();
  return "<hybrid_sphere.Solution from t = " + text::shortest(motion_.begin()) + " to " +
         text::shortest(motion_.end()) + " s, " + std::to_string(count) +
         (count == 1 ? " switch, " : " switches, ") + mechanics::to_string(motion_.status().stop) + ">";
}

py::tuple pair_of(const mechanics::Projection& projection) {
  const Eigen::VectorXd q = projection.q;
  const Eigen::VectorXd v = projection.v;
  return py::make_tuple(q, v);
}

void declare_solution(py::module_& module) {
  const auto motion = [](const PythonSolution& solution) -> const mechanics::Solution& {
    return solution.motion();
  };
  py::class_<PythonSolution>(module, "Solution", solution_doc, collected<PythonSolution>())
      .def("__repr__", &PythonSolution::describe)
      .def("at", &PythonSolution::at, py::arg("times"), at_doc)
      .def_property_readonly("switches", &PythonSolution::switches, solution_switches_doc)
      .def_property_readonly("constraints", &PythonSolution::constraints,
                             "For each constraint how often it was applied, and how long it held [s]: a dict "
                             "name -> (int, float).")
      .def_property_readonly(
          "begin", [=](const PythonSolution& s) { return motion(s).begin(); }, "Where the motion starts [s].")
      .def_property_readonly(
          "end", [=](const PythonSolution& s) { return motion(s).end(); }, "Where it ends [s].")
      .def_property_readonly(
          "reason", [=](const PythonSolution& s) { return mechanics::to_string(motion(s).status().stop); },
          "Why it ends there, in a word: \"reached_end\", or what has stopped it.")
      .def_property_readonly(
          "message", [=](const PythonSolution& s) { return motion(s).status().message; },
          "The same as a sentence, with names and numbers.")
      .def_property_readonly(
          "projection", [=](const PythonSolution& s) { return pair_of(motion(s).projection()); },
          projection_doc)
      .def_property_readonly(
          "estimated_error", [=](const PythonSolution& s) { return motion(s).estimated_error(); },
          "Estimated error of coordinates and velocities at the end, relative to the scale of the motion, as "
          "accuracy is: local errors and rounding of all steps, which grow linearly with the number of times "
          "that "
          "the velocity turns. If it is greater than the accuracy, that is not assured. Excludes the "
          "conditioning of the motion.")
      .def_property_readonly(
          "steps", [=](const PythonSolution& s) { return motion(s).steps(); }, "Of the integrator.")
      .def_property_readonly(
          "evaluations", [=](const PythonSolution& s) { return motion(s).evaluations(); },
          "Of the equations of motion.")
      .def_property_readonly(
          "regularity", [=](const PythonSolution& s) { return motion(s).regularity(); },
          "The smallest scaled pivot of the mass matrix on the way, 1 at best; below 1e-3 the coordinates "
          "come near "
          "a place where they degenerate, and results lose digits.")
      .def_property_readonly(
          "least_regular_time", [=](const PythonSolution& s) { return motion(s).least_regular_time(); },
          "When that is [s].");
}

}  // namespace hybrid_sphere::python
