#include <stdexcept>

#include "hybrid_sphere/scene/scene_error.hpp"
#include "python/numbers_of.hpp"
#include "python/system.hpp"
#include "python/unsized_constraint.hpp"

namespace hybrid_sphere::python {
namespace {

namespace py = pybind11;

void check_size(const char* name, const mechanics::Vector& numbers, const std::vector<std::string>& names) {
  if (numbers.size() == static_cast<mechanics::Index>(names.size())) return;
  std::string list;
  for (const std::string& one : names) list += (list.empty() ? "" : ", ") + one;
  throw std::invalid_argument(std::string(name) + " has " + std::to_string(numbers.size()) +
                              " numbers, not " + std::to_string(names.size()) + ": " + list);
}

mechanics::Stop stop_of(mechanics::ConstraintError::Reason reason) {
  using Reason = mechanics::ConstraintError::Reason;
  switch (reason) {
    case Reason::singular: return mechanics::Stop::singular;
    case Reason::no_direction: return mechanics::Stop::no_direction;
    case Reason::inconsistent: return mechanics::Stop::inconsistent;
    case Reason::no_velocity: return mechanics::Stop::no_velocity;
    case Reason::painleve: return mechanics::Stop::painleve;
  }
  return mechanics::Stop::singular;
}

}  // namespace

mechanics::Vector vector_of(const py::handle& object, const char* name) {
  const Numbers numbers = numbers_of(object, name);
  if (numbers.ndim() != 1) {
    throw scene::SceneError(name, "an array of " + std::to_string(numbers.ndim()) + " dimensions",
                            "a list of numbers");
  }
  const auto values = numbers.unchecked<1>();
  mechanics::Vector result(values.shape(0));
  for (mechanics::Index i = 0; i < result.size(); ++i) result[i] = values(i);
  return result;
}

mechanics::Initial start_of(const std::optional<mechanics::Initial>& usual, const mechanics::Model& model,
                            const MotionRequest& request) {
  mechanics::Initial initial;
  if (usual) initial = *usual;
  const bool has_q = !request.q.is_none();
  const bool has_v = !request.v.is_none();
  if (has_q || has_v || request.t) initial.active.reset();  // elsewhere others may hold
  if (has_q) initial.q = vector_of(request.q, "q");
  if (has_v) initial.v = vector_of(request.v, "v");
  if (request.t) initial.time = *request.t;
  if (!usual && !(has_q && has_v)) {
    throw std::invalid_argument("q and v, where the motion starts, are missing");
  }
  check_size("q", initial.q, model.coordinates);
  check_size("v", initial.v, model.velocities);
  const WhileComputing computing(true);
  try {
    find_sizes(model, initial);
  } catch (const mechanics::NotFinite& error) {
    throw std::invalid_argument(std::string(error.what()) + " where the motion starts");
  }
  return initial;
}

mechanics::Options options_of(const MotionRequest& request, Signals& signals) {
  mechanics::Options options;
  options.accuracy = request.accuracy;
  options.project_initial = request.project;
  options.project_positions = request.project_positions;
  if (request.max_step) options.max_step = *request.max_step;
  options.monitor = [&signals](const mechanics::Progress&) { return !signals.have_come(); };
  return options;
}

WhileComputing::WhileComputing(bool calls_python) {
  if (calls_python) {
    no_warnings_ = py::module_::import("numpy").attr("errstate")(py::arg("all") = "ignore");
    no_warnings_.attr("__enter__")();
  } else {
    released_.emplace();
  }
}

WhileComputing::~WhileComputing() {
  if (!no_warnings_) return;
  try {
    no_warnings_.attr("__exit__")(py::none(), py::none(), py::none());
  } catch (py::error_already_set& error) {
    error.discard_as_unraisable("numpy.errstate");
  }
}

void raise_halted(const mechanics::Status& status, const py::object& states) {
  const py::object type = py::module_::import("hybrid_sphere._errors").attr("Halted");
  const py::object halted = type(status.message, mechanics::to_string(status.stop), status.time, states);
  PyErr_SetObject(type.ptr(), halted.ptr());
  throw py::error_already_set();
}

void raise_halted(const NumericalError& error, double time) {
  const auto* const constraint = dynamic_cast<const mechanics::ConstraintError*>(&error);
  mechanics::Stop stop = mechanics::Stop::not_finite;
  if (constraint != nullptr) stop = stop_of(constraint->reason());
  if (dynamic_cast<const mechanics::Undefined*>(&error) != nullptr) stop = mechanics::Stop::undefined;
  raise_halted({stop, time, error.what()}, py::none());
}

}  // namespace hybrid_sphere::python
