#pragma once

#include <pybind11/numpy.h>

#include <string>

#include "hybrid_sphere/mechanics/rigid_body.hpp"

/// The parts of rigid bodies as objects of Python: vectors are arrays (3,), poses are arrays (4, 4). Whatever
/// has another form throws SceneError with `name`, what it is and what is allowed.
namespace hybrid_sphere::python {

Eigen::Vector3d vector3_of(const pybind11::handle& object, const std::string& name);
/// @param object  (3,) or (6,): xx, yy, zz, xy, xz, yz; or (3, 3)
mechanics::Inertia inertia_of(const pybind11::handle& object);
/// @param object  (4, 4); or (3,): the place of the centre, with axes along the world's
Eigen::Isometry3d placement_of(const pybind11::handle& object);
/// @param object  two vectors
mechanics::Twist twist_of(const pybind11::handle& object, const std::string& name);
mechanics::Wrench wrench_of(const pybind11::handle& object, const std::string& name);
/// @param object  a hybrid_sphere.ContactShape
mechanics::ContactShape shape_of(const pybind11::handle& object);
/// @param object  None, a hybrid_sphere.Plane, or two vectors
mechanics::Plane plane_of(const pybind11::handle& object);

pybind11::array array_of(const Eigen::Vector3d& vector);
/// (4, 4)
pybind11::array array_of(const Eigen::Isometry3d& pose);

}  // namespace hybrid_sphere::python
