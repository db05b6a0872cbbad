#pragma once

#include <pybind11/pybind11.h>

namespace hybrid_sphere::python {

/// hybrid_sphere.Simulation
void declare_simulation(pybind11::module_& module);

}  // namespace hybrid_sphere::python
