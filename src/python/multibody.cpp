#include "python/multibody.hpp"

#include <pybind11/stl.h>

#include <algorithm>

#include "python/body_arguments.hpp"
#include "python/body_functions.hpp"
#include "python/system_functions.hpp"

namespace hybrid_sphere::python {
namespace {

namespace py = pybind11;
using mechanics::MultibodySystem;

/// The methods return the system itself, as those of C++.
py::object add_body(const py::object& self, const std::string& name, double mass, const py::object& inertia,
                    const py::object& placement) {
  self.cast<PythonMultibody&>().bodies().body(name, mass, inertia_of(inertia), placement_of(placement));
  return self;
}

py::object add_point_mass(const py::object& self, const std::string& name, double mass,
                          const py::object& position) {
  self.cast<PythonMultibody&>().bodies().point_mass(name, mass, vector3_of(position, "position"));
  return self;
}

py::object add_thin_rod(const py::object& self, const std::string& name, double mass,
                        const py::object& first_end, const py::object& second_end) {
  self.cast<PythonMultibody&>().bodies().thin_rod(name, mass, vector3_of(first_end, "first_end"),
                                                  vector3_of(second_end, "second_end"));
  return self;
}

py::object add_wrench(const py::object& self, const std::string& body, const py::object& wrench) {
  auto& system = self.cast<PythonMultibody&>();
  if (PyCallable_Check(wrench.ptr()) != 0) {
    system.bodies().apply(body, wrench_function("wrench of body " + body, wrench, system.kept));
  } else {
    system.bodies().apply(body, wrench_of(wrench, "wrench"));
  }
  return self;
}

py::object add_wrench_between(const py::object& self, const std::string& first, const std::string& second,
                              const py::object& wrench) {
  auto& system = self.cast<PythonMultibody&>();
  const std::string label = "wrench between " + first + " and " + second;
  system.bodies().apply(first, second, pair_wrench_function(label, wrench, system.kept));
  return self;
}

py::object add_spring(const py::object& self, const std::string& name, const std::string& first,
                      const std::string& second, const py::object& point_of_first,
                      const py::object& point_of_second, double stiffness, double natural_length) {
  self.cast<PythonMultibody&>().bodies().spring(
      name, first, second, vector3_of(point_of_first, "point_of_first"),
      vector3_of(point_of_second, "point_of_second"), stiffness, natural_length);
  return self;
}

py::object add_damper(const py::object& self, const std::string& name, const std::string& first,
                      const std::string& second, const py::object& point_of_first,
                      const py::object& point_of_second, double coefficient) {
  self.cast<PythonMultibody&>().bodies().damper(name, first, second,
                                                vector3_of(point_of_first, "point_of_first"),
                                                vector3_of(point_of_second, "point_of_second"), coefficient);
  return self;
}

py::object add_torque(const py::object& self, const std::string& hinge, const py::object& torque) {
  auto& system = self.cast<PythonMultibody&>();
  system.bodies().torque(hinge, drive_function("torque of hinge " + hinge, torque, system.kept));
  return self;
}

py::object add_force(const py::object& self, const std::string& slider, const py::object& force) {
  auto& system = self.cast<PythonMultibody&>();
  system.bodies().force(slider, drive_function("force of slider " + slider, force, system.kept));
  return self;
}

py::object add_limit(const py::object& self, const std::string& joint, double lower, double upper,
                     double restitution) {
  MultibodySystem& bodies = self.cast<PythonMultibody&>().bodies();
  for (const char* end : {".lower", ".upper"}) check_new_constraint(bodies, joint + end);
  bodies.limit(joint, lower, upper, restitution);
  return self;
}

py::tuple initial_of_bodies(const PythonMultibody& self, const py::dict& velocities) {
  std::vector<std::pair<std::string, mechanics::Twist>> given;
  for (const auto& [key, value] : velocities) {
    const auto name = py::str(key).cast<std::string>();
    given.emplace_back(name, twist_of(value, "velocities[\"" + name + "\"]"));
  }
  const mechanics::Initial start = self.bodies().initial(given);
  return py::make_tuple(floats(start.q), floats(start.v));
}

py::array poses_of_bodies(const PythonMultibody& self, const py::object& q) {
  const std::vector<Eigen::Isometry3d> all = self.bodies().poses(vector_of(q, "q"));
  py::array_t<double> result({static_cast<py::ssize_t>(all.size()), py::ssize_t{4}, py::ssize_t{4}});
  for (std::size_t i = 0; i < all.size(); ++i) {
    const py::array_t<double> pose = array_of(all[i]);
    std::copy_n(pose.data(), 16, result.mutable_data() + 16 * i);
  }
  return std::move(result);
}

constexpr const char* multibody_doc =
    R"(A hybrid system of rigid bodies, joints and forces between them and contacts with planes.

gravity  in the world [m/s^2]

Each body has seven coordinates, the place of its centre of mass in the world and the unit quaternion that turns its
axes into the world's, NAME.x, .y, .z, .qw, .qx, .qy, .qz, and six velocities, that of the centre of mass in the world,
NAME.vx, .vy, .vz, and the angular velocity on the body's axes, NAME.w1, .w2, .w3. Points and directions of joints and
contacts are given in the world, with all bodies at their placements; a body may be "world". Methods that add a part
return the system itself; they raise ValueError for what is refused, and nothing has changed then.)";

constexpr const char* body_doc = R"(Adds a body.

mass       [kg]
inertia    moments about the centre of mass, on the body's axes [kg m^2]: xx, yy, zz; or xx, yy, zz, xy, xz, yz; or (3, 3)
placement  place of the centre of mass (3,), with axes along the world's, or a pose (4, 4), from the body's axes to the
           world [m])";

constexpr const char* wrench_doc = R"(A force and a torque about the centre of mass, in the world [N, N m].

wrench  a Wrench, or another pair of vectors; or a function wrench(t, body) of the time and of the BodyState, which
        returns such a pair)";

constexpr const char* wrench_between_doc =
    R"(A force and a torque between two bodies. The first one gets the opposite, along the same line.

wrench  on the second body: a function wrench(t, first, second) of the time and of both BodyStates; see force_at)";

constexpr const char* initial_doc = R"(The start at the placements, at t = 0.

velocities  a dict of Twists, or pairs (velocity, angular velocity), in the world, by body. Those of the other bodies
            are the ones of least kinetic energy that the constraints which hold there allow.

Returns (q, v): system.solve(4, *system.initial()). Raises ValueError for velocities that the constraints do not allow.)";

void declare_bodies(MultibodyClass& type) {
  type.def("body", add_body, py::arg("name"), py::arg("mass"), py::arg("inertia"), py::arg("placement"),
           body_doc)
      .def("point_mass", add_point_mass, py::arg("name"), py::arg("mass"), py::arg("position"),
           "A body without moments of inertia. Parts that would turn it are refused.\n\nmass      "
           "[kg]\nposition  in the world [m]")
      .def("thin_rod", add_thin_rod, py::arg("name"), py::arg("mass"), py::arg("first_end"),
           py::arg("second_end"),
           "A straight homogeneous rod without a moment of inertia about its own line, the z axis of the "
           "body.\n\nmass                   [kg]\nfirst_end, second_end  in the world [m]");
}

void declare_forces(MultibodyClass& type) {
  type.def("apply", add_wrench, py::arg("body"), py::arg("wrench"), wrench_doc)
      .def("apply", add_wrench_between, py::arg("first"), py::arg("second"), py::arg("wrench"),
           wrench_between_doc)
      .def("spring", add_spring, py::arg("name"), py::arg("first"), py::arg("second"),
           py::arg("point_of_first"), py::arg("point_of_second"), py::arg("stiffness"),
           py::arg("natural_length"),
           "A spring between points of two bodies. Its potential energy is part of the energy of "
           "states.\n\nstiffness       > 0 [N/m]\nnatural_length  >= 0 [m]")
      .def("damper", add_damper, py::arg("name"), py::arg("first"), py::arg("second"),
           py::arg("point_of_first"), py::arg("point_of_second"), py::arg("coefficient"),
           "A damper between points of two bodies. It pulls with coefficient times the rate of its "
           "length.\n\ncoefficient  > 0 [N s/m]")
      .def("torque", add_torque, py::arg("hinge"), py::arg("torque"),
           "A motor, a torsion spring or a brake in a hinge.\n\ntorque  torque(t, angle, rate), on the "
           "second body about the axis [N m]")
      .def("force", add_force, py::arg("slider"), py::arg("force"),
           "The same in a slider.\n\nforce  force(t, displacement, rate), on the second body along the axis "
           "[N]")
      .def("limit", add_limit, py::arg("joint"), py::arg("lower"), py::arg("upper"),
           py::arg("restitution") = 0.0,
           "Stops a hinge or a slider at the ends of a range: the constraints JOINT.lower and "
           "JOINT.upper.\n\nlower, upper  of angle() within -pi to pi, or of displacement(), also infinite "
           "[rad or m]\nrestitution   0 to 1");
}

void declare_readings(MultibodyClass& type) {
  type.def("initial", initial_of_bodies, py::arg("velocities") = py::dict(), initial_doc)
      .def(
          "pose",
          [](const PythonMultibody& self, const py::object& q, const std::string& body) {
            return array_of(self.bodies().pose(vector_of(q, "q"), body));
          },
          py::arg("q"), py::arg("body"), "From a body's axes to the world, (4, 4).")
      .def("poses", poses_of_bodies, py::arg("q"), "Of all bodies, in their order, (bodies, 4, 4).")
      .def(
          "twist",
          [](const PythonMultibody& self, const py::object& q, const py::object& v, const std::string& body) {
            return twist_object(self.bodies().twist(vector_of(q, "q"), vector_of(v, "v"), body));
          },
          py::arg("q"), py::arg("v"), py::arg("body"),
          "Velocity of the centre of mass and angular velocity, in the world: a Twist.")
      .def(
          "velocity",
          [](const PythonMultibody& self, const py::object& q, const py::object& v, const std::string& body,
             const py::object& point) {
            return array_of(self.bodies().velocity(vector_of(q, "q"), vector_of(v, "v"), body,
                                                   vector3_of(point, "point")));
          },
          py::arg("q"), py::arg("v"), py::arg("body"), py::arg("point"),
          "Velocity of a point of a body, in the world, (3,) [m/s].\n\npoint  on the body's axes, from the "
          "centre of mass [m]");
}

/// A number that is read from q alone, or from q and v.
using OfPlace = double (MultibodySystem::*)(const mechanics::Vector&, const std::string&) const;
using OfMotion = double (MultibodySystem::*)(const mechanics::Vector&, const mechanics::Vector&,
                                             const std::string&) const;

void declare_joint_readings(MultibodyClass& type) {
  const auto of_place = [&type](const char* name, const char* joint, OfPlace read, const char* doc) {
    type.def(
        name,
        [read](const PythonMultibody& self, const py::object& q, const std::string& which) {
          return (self.bodies().*read)(vector_of(q, "q"), which);
        },
        py::arg("q"), py::arg(joint), doc);
  };
  const auto of_motion = [&type](const char* name, const char* joint, OfMotion read, const char* doc) {
    type.def(
        name,
        [read](const PythonMultibody& self, const py::object& q, const py::object& v,
               const std::string& which) {
          return (self.bodies().*read)(vector_of(q, "q"), vector_of(v, "v"), which);
        },
        py::arg("q"), py::arg("v"), py::arg(joint), doc);
  };
  of_place("angle", "hinge", &MultibodySystem::angle,
           "Angle by which the second body of a hinge is turned about the axis, 0 at the placements, in "
           "(-pi, pi] [rad].");
  of_motion("angle_rate", "hinge", &MultibodySystem::angle_rate, "Rate of the angle [rad/s].");
  of_place("displacement", "slider", &MultibodySystem::displacement,
           "Distance by which the second body of a slider has moved along the axis, 0 at the placements "
           "[m].");
  of_motion("displacement_rate", "slider", &MultibodySystem::displacement_rate,
            "Rate of the displacement [m/s].");
}

}  // namespace

void declare_multibody(py::module_& module) {
  MultibodyClass type(module, "MultibodySystem", multibody_doc, collected<PythonMultibody>());
  type.def(py::init([](const py::object& gravity) {
             return std::make_unique<PythonMultibody>(vector3_of(gravity, "gravity"));
           }),
           py::arg("gravity") = py::make_tuple(0.0, 0.0, -9.81));
  declare_bodies(type);
  declare_forces(type);
  declare_joints(type);
  declare_contacts(type);
  declare_readings(type);
  declare_joint_readings(type);
}

}  // namespace hybrid_sphere::python
