#include "mechanics/check_initial.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "mechanics/active_constraints.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::mechanics {
namespace {

void check_size(const char* what, Index size, Index wanted) {
  if (size != wanted) {
    throw std::invalid_argument(std::string(what) + " has " + std::to_string(size) +
                                " components; the model has " + std::to_string(wanted));
  }
}

void check_all_finite(const std::vector<std::string>& names, const Vector& values) {
  for (Index i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) refuse(names[std::size_t(i)], values[i], "a finite number");
  }
}

/// Refuses coordinates that cannot be normalized, as those of a quaternion of length 0.
void check_manifold(const Model& model, const Vector& q) {
  if (!model.normalize) return;
  Vector normalized = q;
  model.normalize(normalized);
  for (Index i = 0; i < q.size(); ++i) {
    if (std::isfinite(normalized[i])) continue;
    refuse(model.coordinates[std::size_t(i)], q[i],
           "coordinates that can be normalized: a quaternion has a length > 0");
  }
}

void check_active(const ActiveSet& active, const Model& model) {
  const std::size_t constraints = model.constraints.size();
  const auto not_ascending = std::adjacent_find(active.begin(), active.end(), std::greater_equal<>());
  if (not_ascending != active.end()) {
    throw std::invalid_argument("the constraints that hold already are not in ascending order");
  }
  if (!active.empty() && active.back() >= constraints) {
    refuse("active", static_cast<double>(active.back()),
           constraints == 0 ? "none, as the model has no constraints"
                            : "0 to " + std::to_string(constraints - 1));
  }
  for (const std::size_t i : active) {
    const auto& friction = model.constraints[i].friction;
    if (!friction || !friction->contact) continue;
    if (contains(active, *friction->contact)) continue;
    throw std::invalid_argument("active: friction " + model.constraints[i].name +
                                " is refused; allowed: with its contact " +
                                model.constraints[*friction->contact].name);
  }
}

}  // namespace

void refuse(const std::string& what, double value, const std::string& allowed) {
  throw std::invalid_argument(text::refusal(what + " = " + text::shortest(value), allowed));
}

void check_state(const Model& model, double t, const Vector& q, const Vector& v) {
  check_size("q", q.size(), model.equations->coordinates());
  check_size("v", v.size(), model.equations->velocities());
  check_all_finite(model.coordinates, q);
  check_all_finite(model.velocities, v);
  check_manifold(model, q);
  if (!std::isfinite(t)) refuse("t", t, "a finite number");
}

void check_state(const Model& model, const State& state) {
  check(model);
  check_state(model, state.time, state.q, state.v);
  check_constraints(model, "active", state.active);
  for (const Slide& slide : state.sliding) {
    check_constraints(model, "sliding", {slide.constraint});
    const Constraint& constraint = model.constraints[slide.constraint];
    if (constraint.friction) continue;
    throw std::invalid_argument(
        text::refusal("sliding: constraint " + constraint.name, "those with friction"));
  }
}

void check(const Model& model, const Initial& initial, const Options& options) {
  check(model);
  check_state(model, initial.time, initial.q, initial.v);
  if (initial.active) check_active(*initial.active, model);
  if (!(options.accuracy >= least_accuracy && options.accuracy <= greatest_accuracy)) {
    refuse("accuracy", options.accuracy,
           text::shortest(least_accuracy) + " to " + text::shortest(greatest_accuracy));
  }
  if (!(options.max_step >= least_time)) refuse("max_step", options.max_step, "a number >= 1e-100");
}

}  // namespace hybrid_sphere::mechanics
