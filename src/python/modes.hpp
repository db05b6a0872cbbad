#pragma once

#include <pybind11/pybind11.h>

namespace hybrid_sphere::python {

/// hybrid_sphere.equilibrium, hybrid_sphere.Modes and hybrid_sphere.modes
void declare_modes(pybind11::module_& module);

}  // namespace hybrid_sphere::python
