// Joints and contacts of hybrid_sphere.MultibodySystem.
#include <pybind11/stl.h>

#include <optional>
#include <stdexcept>

#include "python/body_arguments.hpp"
#include "python/multibody.hpp"
#include "python/system_functions.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::python {
namespace {

namespace py = pybind11;
using mechanics::MultibodySystem;
using Time = std::optional<double>;

/// When a new constraint holds; refuses its name if there is one of that name.
mechanics::When when_of(const py::object& self, const std::string& name, const Time& begin, const Time& end,
                        const py::object& while_positive) {
  auto& system = self.cast<PythonMultibody&>();
  check_new_constraint(*system.model, name);
  mechanics::Schedule schedule = schedule_of(name, begin, end, while_positive, system.kept);
  return {mechanics::Between{schedule.begin, schedule.end}, std::move(schedule.guard)};
}

MultibodySystem& bodies_of(const py::object& self) { return self.cast<PythonMultibody&>().bodies(); }

mechanics::Slip slip_of(const std::string& direction) {
  if (direction == "along") return mechanics::Slip::along;
  if (direction == "across") return mechanics::Slip::across;
  throw std::invalid_argument(text::refusal("direction: \"" + direction + "\"", "along, across"));
}

constexpr const char* joint_when_doc =
    "\n\nIt holds from begin to end [s], None: from before the start, for ever; and while "
    "while_positive(t, q) > 0, a function of\nthe seven coordinates of the first body that is not the "
    "world, None: always.";

std::string with_when(const char* text) { return std::string(text) + joint_when_doc; }

/// A joint at a point, without a direction.
using PointJoint = MultibodySystem& (MultibodySystem::*)(const std::string&, const std::string&,
                                                         const std::string&, const Eigen::Vector3d&,
                                                         const mechanics::When&);
/// A joint at a point, with an axis or a normal.
using AxisJoint = MultibodySystem& (MultibodySystem::*)(const std::string&, const std::string&,
                                                        const std::string&, const Eigen::Vector3d&,
                                                        const Eigen::Vector3d&, const mechanics::When&);

void declare(MultibodyClass& type, const char* name, PointJoint joint, const char* doc) {
  type.def(
      name,
      [joint](const py::object& self, const std::string& constraint, const std::string& first,
              const std::string& second, const py::object& point, const Time& begin, const Time& end,
              const py::object& while_positive) {
        const mechanics::When when = when_of(self, constraint, begin, end, while_positive);
        (bodies_of(self).*joint)(constraint, first, second, vector3_of(point, "point"), when);
        return self;
      },
      py::arg("name"), py::arg("first"), py::arg("second"), py::arg("point"), py::kw_only(),
      py::arg("begin") = py::none(), py::arg("end") = py::none(), py::arg("while_positive") = py::none(),
      with_when(doc).c_str());
}

/// @param point, axis  what the arguments are called
void declare(MultibodyClass& type, const char* name, AxisJoint joint, const char* point, const char* axis,
             const char* doc) {
  type.def(
      name,
      [=](const py::object& self, const std::string& constraint, const std::string& first,
          const std::string& second, const py::object& where, const py::object& direction, const Time& begin,
          const Time& end, const py::object& while_positive) {
        const mechanics::When when = when_of(self, constraint, begin, end, while_positive);
        (bodies_of(self).*joint)(constraint, first, second, vector3_of(where, point),
                                 vector3_of(direction, axis), when);
        return self;
      },
      py::arg("name"), py::arg("first"), py::arg("second"), py::arg(point), py::arg(axis), py::kw_only(),
      py::arg("begin") = py::none(), py::arg("end") = py::none(), py::arg("while_positive") = py::none(),
      with_when(doc).c_str());
}

py::object add_rolling(const py::object& self, const std::string& name, const std::string& body,
                       const py::object& shape, const Time& begin, const Time& end,
                       const py::object& while_positive, const py::object& plane) {
  const mechanics::When when = when_of(self, name, begin, end, while_positive);
  bodies_of(self).rolling(name, body, shape_of(shape), when, plane_of(plane));
  return self;
}

py::object add_blade(const py::object& self, const std::string& name, const std::string& body,
                     const py::object& point, const py::object& direction, const Time& begin, const Time& end,
                     const py::object& while_positive, const py::object& plane) {
  const mechanics::When when = when_of(self, name, begin, end, while_positive);
  bodies_of(self).blade(name, body, vector3_of(point, "point"), vector3_of(direction, "direction"), when,
                        plane_of(plane));
  return self;
}

py::object add_contact(const py::object& self, const std::string& name, const std::string& body,
                       const py::object& shape, double restitution, const py::object& plane) {
  check_new_constraint(bodies_of(self), name);
  bodies_of(self).contact(name, body, shape_of(shape), restitution, plane_of(plane));
  return self;
}

py::object add_friction(const py::object& self, const std::string& name, const std::string& contact,
                        double coefficient, const std::optional<double>& static_coefficient,
                        const std::optional<std::string>& direction) {
  MultibodySystem& bodies = bodies_of(self);
  check_new_constraint(bodies, name);
  if (direction) {
    bodies.friction(name, contact, slip_of(*direction), coefficient, static_coefficient);
  } else {
    bodies.friction(name, contact, coefficient, static_coefficient);
  }
  return self;
}

}  // namespace

void declare_joints(MultibodyClass& type) {
  declare(type, "ball", &MultibodySystem::ball,
          "A point of both bodies in common; three functions, lambda: the force on the second one, in the "
          "world [N].");
  declare(type, "weld", &MultibodySystem::weld,
          "No motion relative to each other; six functions, lambda: the force as of a ball [N], and torques "
          "on the second\nbody about the axes of the first one [N m].");
  declare(type, "hinge", &MultibodySystem::hinge, "point", "axis",
          "An axis in common; five functions, lambda: the force as of a ball [N], and the torques on the "
          "second body about\ntwo directions across the axis [N m].");
  declare(type, "slider", &MultibodySystem::slider, "point", "axis",
          "Only a translation along an axis relative to each other; five functions, lambda: the forces on "
          "the second body\nalong two directions across the axis, at the point [N], and torques as of a "
          "weld [N m].");
  declare(type, "planar", &MultibodySystem::planar, "point", "normal",
          "Only motions in a plane relative to each other; three functions, lambda: the force on the second "
          "body along the\nnormal, at the point [N], and torques about two directions across it [N m].");
  declare(type, "rod", &MultibodySystem::rod, "point_of_first", "point_of_second",
          "The distance of two points stays; one function, lambda: the force that drives them apart [N].");
}

void declare_contacts(MultibodyClass& type) {
  type.def("rolling", add_rolling, py::arg("name"), py::arg("body"), py::arg("shape"), py::kw_only(),
           py::arg("begin") = py::none(), py::arg("end") = py::none(), py::arg("while_positive") = py::none(),
           py::arg("plane") = py::none(),
           with_when("Rolls without slipping on a plane, and does not leave it; three functions, lambda: the "
                     "force on the body at\nthe point of contact, in the world [N].\n\nshape  a "
                     "ContactShape\nplane  a Plane; None: z = 0")
               .c_str())
      .def("blade", add_blade, py::arg("name"), py::arg("body"), py::arg("point"), py::arg("direction"),
           py::kw_only(), py::arg("begin") = py::none(), py::arg("end") = py::none(),
           py::arg("while_positive") = py::none(), py::arg("plane") = py::none(),
           with_when("A skate: a point of the body has no velocity across a direction of the body, along the "
                     "plane; one function,\nlambda: the force on the body to the left of the direction, seen "
                     "from the normal [N].\n\nplane  a Plane; None: z = 0")
               .c_str())
      .def("contact", add_contact, py::arg("name"), py::arg("body"), py::arg("shape"),
           py::arg("restitution") = 0.0, py::arg("plane") = py::none(),
           "Lands on a plane, presses and lifts off; one function, lambda: the force along the normal "
           "[N].\n\nshape        a ContactShape\nrestitution  0 to 1\nplane        a Plane; None: z = 0")
      .def(
          "friction", add_friction, py::arg("name"), py::arg("contact"), py::arg("coefficient"),
          py::arg("static_coefficient") = py::none(), py::kw_only(), py::arg("direction") = py::none(),
          "Coulomb friction of a contact, in all directions along its plane; two functions, lambda: the "
          "force on the body\nalong both [N].\n\ncontact             name of the contact, which has no other "
          "friction\ncoefficient         >= 0\nstatic_coefficient  of what sticks, coefficient or more; "
          "None: coefficient\ndirection           \"along\" or \"across\": in this one alone, one function; "
          "None: in both");
}

}  // namespace hybrid_sphere::python
