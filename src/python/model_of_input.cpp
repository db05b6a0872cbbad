#include "python/model_of_input.hpp"

#include <stdexcept>
#include <utility>
#include <vector>

#include "mechanics/generalised_forces.hpp"
#include "python/python_function.hpp"
#include "python/system.hpp"
#include "python/unsized_constraint.hpp"

namespace hybrid_sphere::python {
namespace {

namespace py = pybind11;

std::string class_of(const py::handle& object) {
  return py::type::of(object).attr("__name__").cast<std::string>();
}

/// None: there is no input, or it is to be 0.
std::optional<mechanics::Vector> numbers_in(const py::object& input) {
  if (input.is_none() || py::isinstance<py::bool_>(input)) return std::nullopt;
  return vector_of(input, "input");
}

}  // namespace

/// Calls model(u).
class PythonModelOfInput::Maker {
 public:
  explicit Maker(py::handle function) : function_(function) {}

  py::object call(const mechanics::Vector& input) {
    py::object made = function_(floats(input));
    if (!py::isinstance<PythonModel>(made)) {
      throw py::type_error("the system for an input is an object of type " + class_of(made) +
                           "; it has to be a Model");
    }
    if (!kept_.list()) kept_.keep(py::reinterpret_borrow<py::object>(function_));
    const KeptFunctions& of_model = made.cast<const PythonModel&>().kept;
    if (of_model.list()) kept_.keep(py::reinterpret_borrow<py::object>(of_model.list()));
    return made;
  }

  mechanics::Model make(const mechanics::Vector& input) {
    const py::gil_scoped_acquire lock;
    const py::object made = call(input);
    mechanics::Model model = *made.cast<const PythonModel&>().model;
    for (std::size_t i = 0; i < model.constraints.size(); ++i) {
      set_size(model.constraints[i], i < sizes_.size() ? sizes_[i] : 1);
    }
    return model;
  }

  void take_sizes(const mechanics::Model& model) {
    sizes_.clear();
    for (const mechanics::Constraint& constraint : model.constraints) {
      sizes_.push_back(constraint.function->size());
    }
  }
  KeptFunctions take_functions() { return std::exchange(kept_, {}); }

 private:
  py::handle function_;  // whoever has a model keeps it
  // Models made since they were taken. The garbage collector does not see them.
  KeptFunctions kept_;
  std::vector<mechanics::Index> sizes_;
};

PythonModelOfInput::PythonModelOfInput(const py::object& system, const py::object& input)
    : input_(numbers_in(input)) {
  py::object made = system;
  if (!py::isinstance<PythonModel>(system)) {
    if (PyCallable_Check(system.ptr()) == 0) {
      throw py::type_error("system is an object of type " + class_of(system) +
                           "; it has to be a Model, or a function of the input that returns one");
    }
    if (!input_) {
      throw std::invalid_argument(
          "the first input is missing: a system that is a function of the input needs input=[...]");
    }
    maker_ = std::make_shared<Maker>(system);
    made = maker_->call(*input_);
  }
  const auto& first = made.cast<const PythonModel&>();
  model_ = *first.model;
  initial_ = first.initial;
  origin_ =
      maker_ ? std::shared_ptr<const void>(std::shared_ptr<const void>(), system.ptr()) : model_.equations;
  if (maker_) return;
  kept_ = first.kept;
  const auto size = static_cast<mechanics::Index>(model_.velocities.size());
  const bool is_true = py::isinstance<py::bool_>(input) && input.cast<bool>();
  if (is_true) input_ = mechanics::Vector::Zero(size);
  if (input_ && input_->size() != size) {
    throw std::invalid_argument("the input has " + std::to_string(input_->size()) + " numbers, not " +
                                std::to_string(size) + ": generalised forces on the velocities");
  }
}

mechanics::ModelOfInput PythonModelOfInput::function() const {
  if (maker_) {
    maker_->take_sizes(model_);
    return [maker = maker_](const mechanics::Vector& input) { return maker->make(input); };
  }
  return [model = model_](const mechanics::Vector& forces) {
    return mechanics::with_generalised_forces(model, forces);
  };
}

void PythonModelOfInput::accept_last() {
  if (maker_) kept_ = maker_->take_functions();
}

void PythonModelOfInput::drop_last() {
  if (maker_) maker_->take_functions();
}

}  // namespace hybrid_sphere::python
