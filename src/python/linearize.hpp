#pragma once

#include <pybind11/pybind11.h>

#include "hybrid_sphere/mechanics/solution.hpp"

namespace hybrid_sphere::python {

/// The state of a model that a user hands over: an item of Solution.at or Plant.state. Finds the sizes of the
/// constraints, too. Throws std::invalid_argument for what is none.
mechanics::State given_state(const mechanics::Model& model, const pybind11::object& given);

/// hybrid_sphere.Linearization and hybrid_sphere.linearize
void declare_linearize(pybind11::module_& module);

}  // namespace hybrid_sphere::python
