#pragma once

#include <pybind11/pybind11.h>

namespace hybrid_sphere::python {

/// Finds the functions of numpy that a Number computes itself.
void find_ufuncs();

/// Number.__array_ufunc__(ufunc, method, *inputs, **keywords): what numpy asks where an input is a Number.
/// Arrays of them do not come here.
PyObject* number_ufunc(PyObject* self, PyObject* arguments, PyObject* keywords);

/// Attributes; numpy looks for several that a Number does not have each time that it meets one.
PyObject* number_attribute(PyObject* self, PyObject* name);

}  // namespace hybrid_sphere::python
