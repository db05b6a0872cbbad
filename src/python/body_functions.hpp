#pragma once

#include "hybrid_sphere/mechanics/rigid_body.hpp"
#include "python/python_function.hpp"

/// Forces of a MultibodySystem from functions written in Python. Each takes the lock of the interpreter where
/// it calls its function.
namespace hybrid_sphere::python {

/// wrench(t, body): a force and a torque. @param label  the name that messages have
mechanics::WrenchFunction wrench_function(const std::string& label, const pybind11::object& function,
                                          KeptFunctions& kept);
/// wrench(t, first, second)
mechanics::PairWrenchFunction pair_wrench_function(const std::string& label, const pybind11::object& function,
                                                   KeptFunctions& kept);
/// drive(t, position, rate): a number
mechanics::DriveFunction drive_function(const std::string& label, const pybind11::object& function,
                                        KeptFunctions& kept);

/// A hybrid_sphere.Twist
pybind11::object twist_object(const mechanics::Twist& twist);

}  // namespace hybrid_sphere::python
