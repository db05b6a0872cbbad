#pragma once

#include <pybind11/numpy.h>

#include <vector>

namespace hybrid_sphere::python {

/// The times of a run, copied, as another thread may change the array.
/// @param from  the earliest one that is allowed [s]
/// @throws SceneError  for what is no list of ascending times, with the index of the first fault
std::vector<double> times_of(const pybind11::object& times, double from);

}  // namespace hybrid_sphere::python
