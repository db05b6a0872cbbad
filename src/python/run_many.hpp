#pragma once

#include <pybind11/pybind11.h>

namespace hybrid_sphere::python {

/// hybrid_sphere.run_many and hybrid_sphere.Runs
void declare_run_many(pybind11::module_& module);

}  // namespace hybrid_sphere::python
