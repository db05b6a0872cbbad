#pragma once

#include <pybind11/pybind11.h>

#include "hybrid_sphere/simulation/simulation.hpp"

/// What C++ throws, as the exceptions of hybrid_sphere/_errors.py.
namespace hybrid_sphere::python {

/// SceneError, HaltedError; all others as pybind11 has them: std::invalid_argument is ValueError.
void register_exceptions();

/// A hybrid_sphere.Halted. @param states  None, or those before it
pybind11::object halted(const HaltedError& error, const pybind11::object& states);

}  // namespace hybrid_sphere::python
