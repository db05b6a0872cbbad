#include "python/system_functions.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "python/python_constraint.hpp"
#include "python/python_equations.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::python {
namespace {

namespace py = pybind11;
using Names = std::vector<std::string>;
using Time = std::optional<double>;

PythonSystem system_of(const Names& coordinates, const py::object& lagrangian, const py::object& forces,
                       const std::optional<Names>& velocities, const py::object& rate,
                       const py::object& normalize) {
  PythonSystem system;
  system.model->coordinates = coordinates;
  if (velocities) {
    system.model->velocities = *velocities;
  } else {
    for (const std::string& name : coordinates) system.model->velocities.push_back(name + "_dot");
  }
  if (rate.is_none() && system.model->velocities.size() != coordinates.size()) {
    throw std::invalid_argument("there are " + std::to_string(coordinates.size()) + " coordinates and " +
                                std::to_string(system.model->velocities.size()) +
                                " velocities; quasi-velocities need a function rate(q, v)");
  }
  if (!rate.is_none() && !velocities) {
    throw std::invalid_argument("quasi-velocities need names: velocities=(\"u\", ...)");
  }
  const auto if_given = [&system](const char* label, const py::object& function) {
    std::optional<PythonFunction> result;
    if (!function.is_none()) result.emplace(label, function, system.kept);
    return result;
  };
  system.model->equations = std::make_shared<PythonEquations>(
      static_cast<Index>(coordinates.size()), static_cast<Index>(system.model->velocities.size()),
      PythonEquations::Functions{
          {"lagrangian", lagrangian, system.kept}, if_given("forces", forces), if_given("rate", rate)});
  if (!normalize.is_none()) {
    system.model->normalize = normalize_function({"normalize", normalize, system.kept});
  }
  mechanics::check(*system.model);
  return system;
}

KeptFunctions& kept_by(const py::object& self) { return self.cast<PythonSystem&>().kept; }

/// When a constraint holds.
struct When {
  Time begin;
  Time end;
  py::object while_positive;
};

/// Adds a constraint to the system that `self` is; nothing has changed where it is refused.
mechanics::Constraint& add_constraint(const py::object& self, const std::string& name,
                                      std::shared_ptr<const mechanics::ConstraintFunction> function,
                                      const When& when) {
  auto& system = self.cast<PythonSystem&>();
  check_new_constraint(*system.model, name);
  mechanics::Schedule schedule = schedule_of(name, when.begin, when.end, when.while_positive, system.kept);
  system.model->constraints.push_back({name, std::move(function), std::move(schedule)});
  return system.model->constraints.back();
}

py::object constrain(const py::object& self, const std::string& name, const py::object& f, const Time& begin,
                     const Time& end, const py::object& while_positive) {
  auto function = std::make_shared<PythonConstraint>(PythonFunction("constraint " + name, f, kept_by(self)));
  add_constraint(self, name, std::move(function), {begin, end, while_positive});
  return self;
}

std::shared_ptr<const mechanics::ConstraintFunction> holonomic_function(const py::object& self,
                                                                        const std::string& name,
                                                                        const py::object& g) {
  return std::make_shared<PythonHolonomicConstraint>(PythonFunction("constraint " + name, g, kept_by(self)),
                                                     self.cast<PythonSystem&>().model->equations);
}

py::object holonomic(const py::object& self, const std::string& name, const py::object& g, const Time& begin,
                     const Time& end, const py::object& while_positive) {
  add_constraint(self, name, holonomic_function(self, name, g), {begin, end, while_positive});
  return self;
}

py::object unilateral(const py::object& self, const std::string& name, const py::object& gap,
                      double restitution) {
  if (!(restitution >= 0 && restitution <= 1)) {
    throw std::invalid_argument(text::refusal("restitution: " + text::shortest(restitution), "0 to 1"));
  }
  const auto overlap =
      std::make_shared<PythonGuard>(PythonFunction("guard of constraint " + name, gap, kept_by(self)), -1);
  mechanics::Constraint& constraint =
      add_constraint(self, name, holonomic_function(self, name, gap), {{}, {}, py::none()});
  constraint.schedule.guard = overlap;
  constraint.unilateral = mechanics::Unilateral{restitution};
  return self;
}

py::object friction(const py::object& self, const std::string& name, const py::object& slip,
                    double coefficient, const std::optional<std::string>& contact, const py::object& load,
                    const std::optional<double>& static_coefficient) {
  if (contact.has_value() != load.is_none()) {
    throw std::invalid_argument("friction " + name + " needs either a contact or a load");
  }
  if (!(coefficient >= 0 && std::isfinite(coefficient))) {
    throw std::invalid_argument(text::refusal("coefficient: " + text::shortest(coefficient), "0 or more"));
  }
  mechanics::Friction law;
  law.coefficient = coefficient;
  law.static_coefficient = static_coefficient;
  if (!(law.of_sticking() >= coefficient && std::isfinite(law.of_sticking()))) {
    throw std::invalid_argument(text::refusal("static_coefficient: " + text::shortest(law.of_sticking()),
                                              "coefficient or more, " + text::shortest(coefficient)));
  }
  const std::vector<mechanics::Constraint>& all = self.cast<PythonSystem&>().model->constraints;
  for (std::size_t i = 0; contact && i < all.size(); ++i) {
    if (all[i].name == *contact && all[i].unilateral) law.contact = i;
  }
  if (contact && !law.contact) {
    throw std::invalid_argument("friction " + name + ": there is no unilateral constraint \"" + *contact +
                                "\"");
  }
  if (!contact)
    law.load = std::make_shared<PythonLoad>(PythonFunction("load of " + name, load, kept_by(self)));
  auto function =
      std::make_shared<PythonConstraint>(PythonFunction("constraint " + name, slip, kept_by(self)));
  add_constraint(self, name, std::move(function), {{}, {}, py::none()}).friction = std::move(law);
  return self;
}

mechanics::Crossing crossing_of(const std::string& name) {
  if (name == "falling") return mechanics::Crossing::falling;
  if (name == "rising") return mechanics::Crossing::rising;
  if (name == "either") return mechanics::Crossing::either;
  throw std::invalid_argument(text::refusal("crossing: \"" + name + "\"", "falling, rising, either"));
}

py::object event(const py::object& self, const std::string& name, const py::object& g,
                 const std::string& crossing, const py::object& reset) {
  auto& system = self.cast<PythonModel&>();
  const auto is_named = [&name](const mechanics::Event& one) { return one.name == name; };
  if (name.empty() || std::any_of(system.model->events.begin(), system.model->events.end(), is_named)) {
    throw std::invalid_argument(
        text::refusal("the name \"" + name + "\" of an event", "a name that no other event has"));
  }
  mechanics::Event event{name, event_function({"event " + name, g, system.kept}), crossing_of(crossing)};
  if (!reset.is_none()) event.reset = reset_function({"reset of event " + name, reset, system.kept});
  system.model->events.push_back(std::move(event));
  return self;
}

constexpr const char* init_doc = R"(A system from functions.

coordinates  names of q, N of them
lagrangian   L(t, q, v), a number
forces       Q(t, q, v), generalised forces that are not in L, (n,); None: none
velocities   names of v, n of them; None: those of the coordinates with _dot
rate         q' as rate(q, v), (N,), linear in quasi-velocities v, whose directions are closed under brackets, as those
             of a rotation are; None: q' = v
normalize    q as normalize(q), (N,): puts coordinates back that integration moves off their manifold, as a quaternion
             to length 1

q and v are arrays: q[0], x, y = q, v @ v, np.sin(q) work. L, rate, constraints, guards and gaps are
differentiated: they are called with arrays of Number, which have no float(): use np.sin, not math.sin. Forces, loads
and events are called with arrays of floats. A function must not keep what it is called with.

Raises ValueError, and TypeError for what is no function.)";

constexpr const char* when_doc =
    "\n\nIt holds from begin to end [s], None: from before the start, for ever; and while while_positive(t, "
    "q) > 0, "
    "None: always.\nWhat holds from before the start has to be satisfied by the initial velocities, or is "
    "projected "
    "(solve(..., project=True)).\n\nReturns the system itself.";

void declare_constraints(py::class_<PythonSystem, PythonModel>& type) {
  type.def(
      "constrain", constrain, py::arg("name"), py::arg("f"), py::kw_only(), py::arg("begin") = py::none(),
      py::arg("end") = py::none(), py::arg("while_positive") = py::none(),
      (std::string(
           "f(t, q, v) = 0, a number, or a list of numbers that are applied and released together. It has "
           "to depend on v.") +
       when_doc)
          .c_str());
  type.def("holonomic", holonomic, py::arg("name"), py::arg("g"), py::kw_only(),
           py::arg("begin") = py::none(), py::arg("end") = py::none(), py::arg("while_positive") = py::none(),
           (std::string("g(t, q) = 0, a number or a list: lengths of rods, positions of joints.") + when_doc)
               .c_str());
}

}  // namespace

void check_new_constraint(const mechanics::Model& model, const std::string& name) {
  const std::vector<mechanics::Constraint>& all = model.constraints;
  const auto is_named = [&name](const mechanics::Constraint& one) { return one.name == name; };
  if (!name.empty() && std::none_of(all.begin(), all.end(), is_named)) return;
  throw std::invalid_argument(
      text::refusal("the name \"" + name + "\" of a constraint", "a name that no other constraint has"));
}

mechanics::Schedule schedule_of(const std::string& name, const Time& begin, const Time& end,
                                const py::object& while_positive, KeptFunctions& kept) {
  const auto is_nan = [](const Time& time) { return time && std::isnan(*time); };
  if (is_nan(begin) || is_nan(end) || (begin && end && *begin > *end)) {
    throw std::invalid_argument("constraint " + name + " needs a begin before its end");
  }
  mechanics::Schedule schedule;
  if (begin) schedule.begin = *begin;
  if (end) schedule.end = *end;
  if (!while_positive.is_none()) {
    schedule.guard =
        std::make_shared<PythonGuard>(PythonFunction("guard of constraint " + name, while_positive, kept), 1);
  }
  return schedule;
}

void declare_functions(py::class_<PythonSystem, PythonModel>& type) {
  type.def(py::init(&system_of), py::arg("coordinates"), py::arg("lagrangian"),
           py::arg("forces") = py::none(), py::kw_only(), py::arg("velocities") = py::none(),
           py::arg("rate") = py::none(), py::arg("normalize") = py::none(), init_doc);
  declare_constraints(type);
  type.def("unilateral", unilateral, py::arg("name"), py::arg("gap"), py::arg("restitution") = 0.0,
           "gap(t, q) >= 0, a number: a body lands, and lifts off where its multiplier would be negative.\n\n"
           "restitution  Poisson's, 0 to 1\n\nReturns the system itself.");
  type.def(
      "friction", friction, py::arg("name"), py::arg("slip"), py::arg("coefficient"), py::kw_only(),
      py::arg("contact") = py::none(), py::arg("load") = py::none(),
      py::arg("static_coefficient") = py::none(),
      "Coulomb friction: slip(t, q, v) = 0, a velocity, or along a plane one of two components, as long as\n"
      "abs(lambda) <= static_coefficient N; else it slides, with coefficient N against the slip.\n\n"
      "contact             name of the unilateral constraint whose multiplier is N; it has no other "
      "friction; or\n"
      "load                N(t, q, v) >= 0, a number\n"
      "static_coefficient  coefficient or more; None: coefficient\n\nReturns the system itself.");
}

void declare_event(py::class_<PythonModel>& type) {
  type.def(
      "event", event, py::arg("name"), py::arg("g"), py::arg("crossing") = "either",
      py::arg("reset") = py::none(),
      "Reports where g(t, q, v), a number, changes its sign, as a switch. Two changes within one step may be "
      "missed:\nmax_step of solve() and Plant bounds the steps.\n\n"
      "crossing  \"rising\", \"falling\" or \"either\"\n"
      "reset     the velocities after it, reset(t, q, v), (n,); None: they stay\n\nReturns the system "
      "itself.");
}

}  // namespace hybrid_sphere::python
