#pragma once

#include <pybind11/pybind11.h>

#include <memory>

#include "python/system.hpp"

namespace hybrid_sphere::python {

/// The constructor of hybrid_sphere.System, and its methods that add constraints and events.
void declare_functions(pybind11::class_<PythonSystem>& type);

}  // namespace hybrid_sphere::python
