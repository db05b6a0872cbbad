#include "python/number_ufunc.hpp"

#include <pybind11/numpy.h>

#include <cstring>
#include <unordered_map>

#include "python/number_arithmetic.hpp"
#include "python/number_object.hpp"
#include "python/python_function.hpp"

namespace hybrid_sphere::python {
namespace {

namespace py = pybind11;

// By the object of numpy, which lives as long as the interpreter.
std::unordered_map<PyObject*, NumberFunction>& functions() {
  static std::unordered_map<PyObject*, NumberFunction> all;
  return all;
}

/// The result, or null without an exception where it is left to numpy.
PyObject* quickly(PyObject* ufunc, PyObject* arguments) {
  const auto found = functions().find(ufunc);
  if (found == functions().end()) return nullptr;
  const NumberFunction& function = found->second;
  const Py_ssize_t inputs = PyTuple_GET_SIZE(arguments) - 2;
  PyObject* const first = PyTuple_GET_ITEM(arguments, 2);
  Operand x, y;
  if (inputs == 1 && function.of_one != nullptr) return function.of_one(first, nullptr);
  if (inputs != 2 || function.of_two == nullptr) return nullptr;
  PyObject* const second = PyTuple_GET_ITEM(arguments, 3);
  return read(first, x) && read(second, y) ? function.of_two(first, second) : nullptr;
}

/// The inputs, with an array of one item for each Number.
py::tuple as_arrays(PyObject* arguments) {
  const Py_ssize_t inputs = PyTuple_GET_SIZE(arguments) - 2;
  py::tuple result(inputs);
  for (Py_ssize_t i = 0; i < inputs; ++i) {
    const auto input = py::reinterpret_borrow<py::object>(PyTuple_GET_ITEM(arguments, i + 2));
    Operand operand;
    if (!read(input.ptr(), operand) || operand.number == nullptr) {
      result[static_cast<std::size_t>(i)] = input;
      continue;
    }
    PyObject** item = nullptr;
    const py::object array = object_array(1, item);
    *item = input.inc_ref().ptr();
    result[static_cast<std::size_t>(i)] = array.attr("reshape")(py::tuple());
  }
  return result;
}

}  // namespace

void find_ufuncs() {
  const py::module_ numpy = py::module_::import("numpy");
  for (const NumberFunction& function : number_functions()) {
    functions()[numpy.attr(function.ufunc).cast<py::object>().release().ptr()] = function;
  }
}

PyObject* number_ufunc(PyObject* /*self*/, PyObject* arguments, PyObject* keywords) {
  if (PyTuple_GET_SIZE(arguments) < 3 || PyUnicode_Check(PyTuple_GET_ITEM(arguments, 1)) == 0) {
    PyErr_SetString(PyExc_TypeError, "__array_ufunc__(ufunc, method, *inputs)");
    return nullptr;
  }
  PyObject* const ufunc = PyTuple_GET_ITEM(arguments, 0);
  PyObject* const method = PyTuple_GET_ITEM(arguments, 1);
  if ((keywords == nullptr || PyDict_GET_SIZE(keywords) == 0) &&
      PyUnicode_CompareWithASCIIString(method, "__call__") == 0) {
    PyObject* const result = quickly(ufunc, arguments);
    if (result != nullptr || PyErr_Occurred() != nullptr) return result;
  }
  try {
    const py::object call = py::reinterpret_steal<py::object>(PyObject_GetAttr(ufunc, method));
    if (!call) return nullptr;
    return PyObject_Call(call.ptr(), as_arrays(arguments).ptr(), keywords);
  } catch (py::error_already_set& error) {
    error.restore();
    return nullptr;
  }
}

PyObject* number_attribute(PyObject* self, PyObject* name) {
  const char* const text = PyUnicode_AsUTF8(name);
  if (text == nullptr) return nullptr;
  for (const char* const missing : {"__array__", "__array_interface__", "__array_struct__"}) {
    if (std::strcmp(text, missing) != 0) continue;
    PyErr_SetNone(PyExc_AttributeError);  // no time for a message
    return nullptr;
  }
  return PyObject_GenericGetAttr(self, name);
}

}  // namespace hybrid_sphere::python
