#include "catalogue/entry_helpers.hpp"

#include <algorithm>
#include <stdexcept>

#include "mechanics/guards.hpp"

namespace hybrid_sphere::mechanics::catalogue {

Parameter positive(const std::string& name, double value, const std::string& meaning) {
  return {name, value, 1e-9, 1e9, meaning};
}

Parameter not_negative(const std::string& name, double value, const std::string& meaning) {
  return {name, value, 0, 1e9, meaning};
}

Parameter number(const std::string& name, double value, const std::string& meaning) {
  return {name, value, -1e9, 1e9, meaning};
}

Parameter switch_time(double value) {
  return not_negative("t_switch", value, "when the constraint is applied [s]");
}

void refuse(const std::string& name, double value, const std::string& allowed) {
  throw std::invalid_argument(text::refusal(name + " = " + shortest(value), allowed));
}

Vector vector(std::initializer_list<double> components) {
  Vector result(static_cast<Index>(components.size()));
  std::copy(components.begin(), components.end(), result.data());
  return result;
}

Initial initial_state(const Model& model, const Values& values) {
  const auto named = [&values](const std::vector<std::string>& names) {
    Vector result(static_cast<Index>(names.size()));
    std::transform(names.begin(), names.end(), result.data(),
                   [&values](const std::string& name) { return values[name]; });
    return result;
  };
  return {0, named(model.coordinates), named(model.velocities)};
}

int side_at_start(const Model& model, const Initial& initial) {
  return sign_of(*model.constraints.front().schedule.guard, initial.time, initial.q, initial.q.cwiseAbs());
}

Known flight(const Initial& initial, const Vector& acceleration, Index multipliers, double t) {
  return {initial.q + t * (initial.v + t / 2 * acceleration), initial.v + t * acceleration,
          Vector::Zero(multipliers)};
}

Invariant energy() {
  return {"energy", [](const State& state) { return state.energy; }};
}

}  // namespace hybrid_sphere::mechanics::catalogue
