#pragma once

#include <pybind11/pybind11.h>

#include <optional>
#include <string>

#include "python/system.hpp"

namespace hybrid_sphere::python {

/// The constructor of hybrid_sphere.System, and its methods that add constraints.
void declare_functions(pybind11::class_<PythonSystem, PythonModel>& type);

/// hybrid_sphere.Model.event
void declare_event(pybind11::class_<PythonModel>& type);

/// Refuses an empty name, and one that a constraint of the model has. Throws std::invalid_argument.
void check_new_constraint(const mechanics::Model& model, const std::string& name);

/// When a constraint holds, as the arguments begin, end and while_positive of Python say.
/// @param name  of the constraint
/// @param kept  keeps the function while_positive
/// Throws std::invalid_argument for an end before the begin, and TypeError for what is no function.
mechanics::Schedule schedule_of(const std::string& name, const std::optional<double>& begin,
                                const std::optional<double>& end, const pybind11::object& while_positive,
                                KeptFunctions& kept);

}  // namespace hybrid_sphere::python
