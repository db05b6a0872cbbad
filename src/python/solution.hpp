#pragma once

#include <pybind11/numpy.h>

#include "python/exclusive_use.hpp"
#include "python/motion_arrays.hpp"
#include "python/system.hpp"

namespace hybrid_sphere::python {

/// hybrid_sphere.Solution
class PythonSolution {
 public:
  PythonSolution(const PythonModel& system, double duration, const MotionRequest& request);

  pybind11::object at(const pybind11::object& given);
  pybind11::array switches();
  pybind11::dict constraints() const;
  const mechanics::Solution& motion() const { return motion_; }
  const KeptFunctions& functions() const { return functions_; }
  pybind11::object let_go();
  std::string describe() const;

 private:
  void check_times(const std::vector<double>& times) const;

  KeptFunctions functions_;
  mechanics::Model model_;
  mechanics::Solution motion_;
  MotionTable states_;
  InUse in_use_;
};

/// The changes of q (N) and v (n), as arrays.
pybind11::tuple pair_of(const mechanics::Projection& projection);

constexpr const char* projection_doc =
    "How far the initial state was moved onto the constraints by project_positions and project: a tuple of "
    "the "
    "changes of q, (N,), and of v, (n,). Round-off without them.";

void declare_solution(pybind11::module_& module);

}  // namespace hybrid_sphere::python
