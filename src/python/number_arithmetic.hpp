#pragma once

#include <pybind11/pybind11.h>

#include <vector>

namespace hybrid_sphere::python {

/// What a Number does with operators.
std::vector<PyType_Slot> number_operations();

/// What it computes itself where numpy is asked for `ufunc`; one of the two is null. Operands are Numbers and
/// real numbers.
struct NumberFunction {
  const char* ufunc;
  PyObject* (*of_one)(PyObject* x, PyObject* none);
  PyObject* (*of_two)(PyObject* x, PyObject* y);
};
std::vector<NumberFunction> number_functions();

/// Its methods, with the names that numpy looks for.
PyMethodDef* number_methods();

}  // namespace hybrid_sphere::python
