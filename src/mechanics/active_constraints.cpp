#include "mechanics/active_constraints.hpp"

#include <algorithm>

namespace hybrid_sphere::mechanics {

void ActiveConstraints::set(const ActiveSet& active) {
  if (active == active_) return;
  check_constraints(*model_, "active", active);
  active_ = active;
  owner_.clear();
  values_.resize(active.size());
  gradients_.resize(active.size());
  multipliers_.resize(active.size());
  for (const std::size_t i : active) {
    owner_.insert(owner_.end(), static_cast<std::size_t>(model_->constraints[i].function->size()), i);
  }
}

void ActiveConstraints::evaluate(double t, const Vector& q, const Vector& v, Vector& value,
                                 Matrix& gradient) {
  value.resize(size());
  gradient.resize(size(), v.size());
  Index row = 0;
  for (std::size_t i = 0; i < active_.size(); ++i) {
    const Constraint& constraint = model_->constraints[active_[i]];
    constraint.function->evaluate(t, q, v, values_[i], gradients_[i]);
    if (!values_[i].allFinite() || !gradients_[i].allFinite()) {
      throw NotFinite("constraint " + constraint.name);
    }
    const Index functions = constraint.function->size();
    value.segment(row, functions) = values_[i];
    gradient.middleRows(row, functions) = gradients_[i];
    row += functions;
  }
}

void ActiveConstraints::add_curvature(double t, const Vector& q, const Vector& v, const Vector& multipliers,
                                      Matrix& sum) {
  Index row = 0;
  for (std::size_t i = 0; i < active_.size(); ++i) {
    const Constraint& constraint = model_->constraints[active_[i]];
    multipliers_[i] = multipliers.segment(row, constraint.function->size());
    constraint.function->add_curvature(t, q, v, multipliers_[i], sum);
    if (!sum.allFinite()) throw NotFinite("constraint " + constraint.name);
    row += multipliers_[i].size();
  }
}

ActiveSet ActiveConstraints::owners(const std::vector<Index>& rows) const {
  ActiveSet set;
  for (const Index row : rows) {
    const std::size_t owner = owner_[static_cast<std::size_t>(row)];
    if (set.empty() || set.back() != owner) set.push_back(owner);
  }
  return set;
}

std::string ActiveConstraints::name_of(Index row) const {
  const std::size_t owner = owner_[static_cast<std::size_t>(row)];
  const std::string name = "constraint " + model_->constraints[owner].name;
  if (model_->constraints[owner].function->size() == 1) return name;
  const auto first = std::find(owner_.begin(), owner_.end(), owner) - owner_.begin();
  return "function " + std::to_string(row - first + 1) + " of " + name;
}

}  // namespace hybrid_sphere::mechanics
