#pragma once

#include <pybind11/pybind11.h>

namespace hybrid_sphere::python {

/// hybrid_sphere.Plant and its snapshots
void declare_plant(pybind11::module_& module);

}  // namespace hybrid_sphere::python
