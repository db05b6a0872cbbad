#include "hybrid_sphere/mechanics/model.hpp"

#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>

#include "mechanics/sliding_friction.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::mechanics {
namespace {

void check_number(const std::vector<std::string>& all, const std::string& what, Index size) {
  if (static_cast<Index>(all.size()) == size) return;
  throw std::invalid_argument("model: " + std::to_string(all.size()) + " names of " + what +
                              ", but its equations have " + std::to_string(size));
}

void check_name(const std::string& name, const std::string& what, std::set<std::string>& seen) {
  if (name.empty()) throw std::invalid_argument("model: a " + what + " has an empty name");
  if (!seen.insert(name).second) {
    throw std::invalid_argument("model: the name \"" + name + "\" of a " + what + " appears twice");
  }
}

void check_constraint(const Constraint& constraint) {
  const std::string subject = "constraint " + constraint.name + ": ";
  if (!constraint.function) throw std::invalid_argument(subject + "it has no function");
  if (constraint.function->size() < 1) {
    throw std::invalid_argument(subject + "size() is " + std::to_string(constraint.function->size()) +
                                "; at least 1 is needed");
  }
  const Schedule& schedule = constraint.schedule;
  if (std::isnan(schedule.begin) || std::isnan(schedule.end)) {
    throw std::invalid_argument(subject + "its interval begins or ends at NaN");
  }
  if (schedule.end < schedule.begin) {
    std::ostringstream message;
    message.precision(12);
    message << subject << "its interval ends at " << schedule.end << " before it begins at "
            << schedule.begin;
    throw std::invalid_argument(message.str());
  }
}

void check_unilateral(const Constraint& constraint) {
  if (!constraint.unilateral) return;
  const std::string subject = "constraint " + constraint.name + ": ";
  if (constraint.function->size() != 1 || !constraint.schedule.guard ||
      !constraint.function->has_position()) {
    throw std::invalid_argument(subject +
                                "a unilateral constraint has one function, its position and a guard");
  }
  const double restitution = constraint.unilateral->restitution;
  if (!(restitution >= 0 && restitution <= 1)) {
    throw std::invalid_argument(subject +
                                text::refusal("restitution = " + text::shortest(restitution), "0 to 1"));
  }
}

void check_friction(const Model& model, const Constraint& constraint) {
  if (!constraint.friction) return;
  const std::string subject = "friction " + constraint.name + ": ";
  const Friction& friction = *constraint.friction;
  if (constraint.function->size() > 2) {
    throw std::invalid_argument(subject + "its slip velocity has " +
                                std::to_string(constraint.function->size()) + " components, not 1 or 2");
  }
  if (constraint.unilateral) throw std::invalid_argument(subject + "it is a unilateral constraint");
  if (constraint.schedule.guard)
    throw std::invalid_argument(subject + "it has a guard; its load may be 0 instead");
  if (friction.contact && friction.load) {
    throw std::invalid_argument(subject + "it has two loads, a contact's and one that is known");
  }
  check_coefficients("friction " + constraint.name, friction);
  if (!friction.contact && !friction.load) throw std::invalid_argument(subject + "it has no load");
  if (friction.contact &&
      (*friction.contact >= model.constraints.size() || !model.constraints[*friction.contact].unilateral)) {
    throw std::invalid_argument(subject + "its load is not that of a unilateral constraint");
  }
}

/// Two frictions of one contact would have a limit each, and together more than Coulomb's.
void check_frictions_of_contacts(const Model& model) {
  std::map<std::size_t, std::string> known;
  for (const Constraint& constraint : model.constraints) {
    if (!constraint.friction || !constraint.friction->contact) continue;
    const std::size_t contact = *constraint.friction->contact;
    const auto [place, is_new] = known.emplace(contact, constraint.name);
    if (is_new) continue;
    throw std::invalid_argument("friction " + constraint.name + ": constraint " +
                                model.constraints[contact].name + " has the friction " + place->second +
                                " already; for all directions along a plane a friction has a slip velocity "
                                "of two components");
  }
}

}  // namespace

void EquationsOfMotion::steady_axes(const Vector& /*q*/, const Vector& v, const Vector& /*acceleration*/,
                                    Matrix& axes, Matrix& axes_rate) const {
  axes.setIdentity(v.size(), v.size());
  axes_rate.setZero(v.size(), v.size());
}

void EquationsOfMotion::directions(const Vector& q, const Vector& v, Matrix& directions,
                                   Vector& drift) const {
  Vector rate;
  this->rate(q, v, rate);
  if (rate.size() != v.size() || rate != v) {
    throw std::logic_error("equations of quasi-velocities have to supply directions()");
  }
  directions.setIdentity(v.size(), v.size());
  drift.setZero(v.size());
}

Index Model::multipliers() const { return multiplier_of(constraints.size()); }

Index Model::multiplier_of(std::size_t constraint) const {
  if (constraint > constraints.size()) {
    throw std::out_of_range(text::refusal("multiplier_of: constraint " + std::to_string(constraint),
                                          "0 to " + std::to_string(constraints.size())));
  }
  Index first = 0;
  for (std::size_t i = 0; i < constraint; ++i) first += constraints[i].function->size();
  return first;
}

std::size_t Model::index_of_constraint(const std::string& name) const {
  std::string known;
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    if (constraints[i].name == name) return i;
    known += (i == 0 ? "" : ", ") + constraints[i].name;
  }
  throw std::invalid_argument(text::refusal("constraint \"" + name + "\"", known.empty() ? "none" : known));
}

Vector Model::multipliers_of(const std::string& constraint, const Vector& multipliers) const {
  const std::size_t i = index_of_constraint(constraint);
  if (multipliers.size() != this->multipliers()) {
    throw std::invalid_argument(text::refusal(std::to_string(multipliers.size()) + " multipliers",
                                              std::to_string(this->multipliers())));
  }
  return multipliers.segment(multiplier_of(i), constraints[i].function->size());
}

void check_constraints(const Model& model, const char* name, const ActiveSet& set) {
  for (const std::size_t i : set) {
    if (i < model.constraints.size()) continue;
    throw std::out_of_range(text::refusal(
        std::string(name) + ": constraint " + std::to_string(i),
        model.constraints.empty() ? "none" : "0 to " + std::to_string(model.constraints.size() - 1)));
  }
}

std::string names(const Model& model, const ActiveSet& set) {
  check_constraints(model, "names", set);
  std::string list;
  for (const std::size_t i : set) list += (list.empty() ? "" : ", ") + model.constraints[i].name;
  return list;
}

std::string describe(const Model& model, double t, const Vector& q, const Vector& v) {
  std::ostringstream text;
  text.precision(12);
  text << "t = " << t;
  const auto add = [&](const std::vector<std::string>& all, const Vector& values) {
    for (Index i = 0; i < values.size(); ++i) {
      const auto place = static_cast<std::size_t>(i);
      text << ", " << (place < all.size() ? all[place] : "component " + std::to_string(i)) << " = "
           << values[i];
    }
  };
  add(model.coordinates, q);
  add(model.velocities, v);
  return text.str();
}

void check(const Model& model) {
  if (!model.equations) throw std::invalid_argument("model: it has no equations of motion");
  if (model.equations->velocities() < 1 || model.equations->coordinates() < 1) {
    throw std::invalid_argument(
        "model: its equations have " + std::to_string(model.equations->coordinates()) + " coordinates and " +
        std::to_string(model.equations->velocities()) + " velocities; at least 1 of each is needed");
  }
  check_number(model.coordinates, "coordinates", model.equations->coordinates());
  check_number(model.velocities, "velocities", model.equations->velocities());
  std::set<std::string> columns;
  for (const std::string& name : model.coordinates) check_name(name, "coordinate", columns);
  for (const std::string& name : model.velocities) check_name(name, "velocity", columns);
  std::set<std::string> constraints;
  for (const Constraint& constraint : model.constraints) {
    check_name(constraint.name, "constraint", constraints);
    check_constraint(constraint);
    check_unilateral(constraint);
    check_friction(model, constraint);
  }
  check_frictions_of_contacts(model);
  std::set<std::string> events;
  for (const Event& event : model.events) {
    check_name(event.name, "event", events);
    if (!event.function) throw std::invalid_argument("event " + event.name + ": it has no function");
  }
}

}  // namespace hybrid_sphere::mechanics
