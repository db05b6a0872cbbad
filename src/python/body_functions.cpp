#include "python/body_functions.hpp"

#include <utility>

#include "python/body_arguments.hpp"

namespace hybrid_sphere::python {
namespace {

namespace py = pybind11;

py::object tuple_type(const char* name) { return py::module_::import("hybrid_sphere._bodies").attr(name); }

py::object state_object(const mechanics::BodyState& state) {
  return tuple_type("BodyState")(array_of(state.pose), twist_object(state.twist));
}

}  // namespace

py::object twist_object(const mechanics::Twist& twist) {
  return tuple_type("Twist")(array_of(twist.velocity), array_of(twist.angular_velocity));
}

mechanics::WrenchFunction wrench_function(const std::string& label, const py::object& function,
                                          KeptFunctions& kept) {
  return [wrench = PythonFunction(label, function, kept)](double t, const mechanics::BodyState& body) {
    const py::gil_scoped_acquire lock;
    return wrench_of(wrench.call(t, state_object(body)), "the result of " + wrench.label());
  };
}

mechanics::PairWrenchFunction pair_wrench_function(const std::string& label, const py::object& function,
                                                   KeptFunctions& kept) {
  return [wrench = PythonFunction(label, function, kept)](double t, const mechanics::BodyState& first,
                                                          const mechanics::BodyState& second) {
    const py::gil_scoped_acquire lock;
    return wrench_of(wrench.call(t, state_object(first), state_object(second)),
                     "the result of " + wrench.label());
  };
}

mechanics::DriveFunction drive_function(const std::string& label, const py::object& function,
                                        KeptFunctions& kept) {
  return [drive = PythonFunction(label, function, kept)](double t, double position, double rate) {
    const py::gil_scoped_acquire lock;
    return drive(PythonFunction::one, {}, t, position, rate)[0].value;
  };
}

}  // namespace hybrid_sphere::python
