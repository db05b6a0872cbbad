#pragma once

#include <string>

#include "python/system.hpp"

namespace hybrid_sphere::python {

/// The names of all entries of the catalogue.
pybind11::tuple catalogue_names();

/// An entry with its initial state.
/// Throws SceneError for a name, a parameter or a value that is not allowed.
PythonSystem of_catalogue(const std::string& name, const pybind11::kwargs& parameters);

}  // namespace hybrid_sphere::python
