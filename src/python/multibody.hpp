#pragma once

#include <pybind11/pybind11.h>

#include <memory>

#include "hybrid_sphere/mechanics/multibody_system.hpp"
#include "python/system.hpp"

namespace hybrid_sphere::python {

/// hybrid_sphere.MultibodySystem: its model is a MultibodySystem.
struct PythonMultibody : PythonModel {
  explicit PythonMultibody(const Eigen::Vector3d& gravity) {
    model = std::make_shared<mechanics::MultibodySystem>(gravity);
  }
  mechanics::MultibodySystem& bodies() const { return static_cast<mechanics::MultibodySystem&>(*model); }
  pybind11::object let_go() {
    bodies() = mechanics::MultibodySystem();
    return kept.let_go();
  }
};

using MultibodyClass = pybind11::class_<PythonMultibody, PythonModel>;

/// Joints and contacts.
void declare_joints(MultibodyClass& type);
void declare_contacts(MultibodyClass& type);

void declare_multibody(pybind11::module_& module);

}  // namespace hybrid_sphere::python
