#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "scene/tree.hpp"

namespace hybrid_sphere::python {

/// What Python objects say, as a scene file would: dicts (any Mapping) with texts for keys, lists, tuples and
/// arrays, texts and paths, numbers, booleans, None.
/// @param path  of the object, put before keys in refusals; empty for a scene
/// @throws SceneError  for any other object, and beyond the limits of a scene file
scene::Tree tree_of(const pybind11::handle& object, const std::string& path = "");

}  // namespace hybrid_sphere::python
