#pragma once

#include <pybind11/pybind11.h>

namespace hybrid_sphere::python {

/// hybrid_sphere.Linearization and hybrid_sphere.linearize
void declare_linearize(pybind11::module_& module);

}  // namespace hybrid_sphere::python
