#include "python/python_function.hpp"

#include <pybind11/numpy.h>

#include <cmath>
#include <utility>

#include "hybrid_sphere/mechanics/user_function.hpp"

namespace hybrid_sphere::python {
namespace {

namespace py = pybind11;

const py::dtype& object_dtype() {
  static const auto* const dtype = new py::dtype("O");  // lives as long as the interpreter
  return *dtype;
}

/// "an array of shape (2, 3)", "None", "an object of type str"
std::string kind_of(const py::object& object) {
  if (object.is_none()) return "None";
  if (py::isinstance<py::array>(object)) {
    return "an array of shape " + py::str(object.attr("shape")).cast<std::string>();
  }
  const std::string type = py::str(py::type::of(object).attr("__name__"));
  if (py::isinstance<py::list>(object) || py::isinstance<py::tuple>(object)) {
    return "a " + type + " of " + std::to_string(py::len(object));
  }
  return "an object of type " + type;
}

}  // namespace

PythonFunction::PythonFunction(std::string label, const py::object& function, KeptFunctions& kept)
    : label_(std::move(label)) {
  if (PyCallable_Check(function.ptr()) == 0) {
    throw py::type_error(label_ + " has to be a function, not " + kind_of(function));
  }
  function_ = kept.keep(function);
}

void PythonFunction::check_derivative(bool is_finite) const {
  mechanics::user_function::check_derivative(is_finite, label_);
}

void PythonFunction::refuse(const py::object& result, Index size) const {
  const std::string wanted = size == one        ? "a number"
                             : size == any_size ? "a number or a list of numbers"
                                                : "a list of " + std::to_string(size) + " numbers";
  throw py::value_error(label_ + " returns " + kind_of(result) + "; it has to return " + wanted);
}

Results PythonFunction::results_of(py::object result, Index size, const NumberShape& shape) const {
  std::vector<Operand> numbers(1);
  if (py::isinstance<py::array>(result) && py::reinterpret_borrow<py::array>(result).ndim() == 0) {
    result = result.attr("item")();
  }
  if (read(result.ptr(), numbers[0])) {
    if (size > 1) refuse(result, size);
    numbers[0] = number_of(result.ptr(), shape);
    return {std::move(result), std::move(numbers)};
  }
  if (py::isinstance<py::str>(result) || PySequence_Check(result.ptr()) == 0) refuse(result, size);
  const py::object items =
      py::reinterpret_steal<py::object>(PySequence_Tuple(result.ptr()));  // no one changes it
  if (!items) throw py::error_already_set();
  const Index count = PyTuple_GET_SIZE(items.ptr());
  if (count == 0 || (size == one && count != 1) || (size > 0 && count != size)) refuse(result, size);
  numbers.resize(static_cast<std::size_t>(count));
  for (Index i = 0; i < count; ++i) {
    PyObject* const item = PyTuple_GET_ITEM(items.ptr(), i);
    Operand operand;
    if (!read(item, operand)) {
      if (py::isinstance<py::array>(item)) refuse(result, size);
      throw py::type_error(label_ + " returns, as number " + std::to_string(i) + ", " +
                           kind_of(py::reinterpret_borrow<py::object>(item)) + "; it has to be a number");
    }
    numbers[static_cast<std::size_t>(i)] = number_of(item, shape);
  }
  return {items, std::move(numbers)};
}

Operand PythonFunction::number_of(PyObject* object, const NumberShape& shape) const {
  Operand operand;
  read(object, operand);
  if (!operand.is_constant() && !(operand.number->shape == shape)) {
    throw py::value_error(label_ + " returns a Number of another call: a function must not keep them");
  }
  mechanics::user_function::check_value(std::isfinite(operand.value), label_);
  return operand;
}

py::object object_array(Index size, PyObject**& items) {
  py::array array(object_dtype(), size);
  items = reinterpret_cast<PyObject**>(array.mutable_data());
  for (Index i = 0; i < size; ++i) Py_CLEAR(items[i]);
  return std::move(array);
}

py::object number(double value, const NumberShape& shape, int slope) {
  NumberObject* const result = new_number(shape, value);
  if (slope >= 0) result->data[1 + slope] = 1;
  return py::reinterpret_steal<py::object>(as_object(result));
}

py::object numbers(const Vector& values) {
  return numbers(values, {}, [](Index /*i*/, double* /*slopes*/) {});
}

py::object floats(const Vector& values) { return py::array_t<double>(values.size(), values.data()); }

}  // namespace hybrid_sphere::python
