#include "hybrid_sphere/mechanics/model.hpp"

#include <cmath>
#include <set>
#include <sstream>
#include <stdexcept>

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

}  // namespace

Index Model::multipliers() const { return multiplier_of(constraints.size()); }

Index Model::multiplier_of(std::size_t constraint) const {
  Index first = 0;
  for (std::size_t i = 0; i < constraint; ++i) first += constraints[i].function->size();
  return first;
}

std::string names(const Model& model, const ActiveSet& set) {
  std::string list;
  for (const std::size_t i : set) list += (list.empty() ? "" : ", ") + model.constraints[i].name;
  return list;
}

std::string describe(const Model& model, double t, const Vector& q, const Vector& v) {
  std::ostringstream text;
  text.precision(12);
  text << "t = " << t;
  for (Index i = 0; i < q.size(); ++i) text << ", " << model.coordinates[std::size_t(i)] << " = " << q[i];
  for (Index i = 0; i < v.size(); ++i) text << ", " << model.velocities[std::size_t(i)] << " = " << v[i];
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
  }
}

}  // namespace hybrid_sphere::mechanics
