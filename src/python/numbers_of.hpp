#pragma once

#include <pybind11/numpy.h>

#include <string>

namespace hybrid_sphere::python {

using Numbers = pybind11::array_t<double, pybind11::array::forcecast>;

/// Real numbers, of any shape: no masked or complex ones, no texts, booleans or dates.
/// @param name  put before the refusal
/// @throws SceneError
Numbers numbers_of(const pybind11::handle& object, const std::string& name);

/// Where what has been raised only says that a value is of the wrong kind, forgets it; what else has been
/// raised goes on.
void forget_wrong_kind();

}  // namespace hybrid_sphere::python
