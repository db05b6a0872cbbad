#include "mechanics/active_constraints.hpp"

#include <algorithm>

namespace hybrid_sphere::mechanics {

void ActiveConstraints::set(const ActiveSet& active) {
  if (active == active_ && have_same_columns()) return;
  check_constraints(*model_, "active", active);
  active_ = active;
  owner_.clear();
  values_.resize(active.size());
  gradients_.resize(active.size());
  multipliers_.resize(active.size());
  for (const std::size_t i : active) {
    owner_.insert(owner_.end(), static_cast<std::size_t>(model_->constraints[i].function->size()), i);
  }
  set_columns();
}

/// Whether the columns are still those of the model: a plant with another input has another one.
bool ActiveConstraints::have_same_columns() const {
  const Index n = model_->equations->velocities();
  for (std::size_t i = 0; i < active_.size(); ++i) {
    auto columns = columns_[i].begin();
    for (Index s = 0; s < n; ++s) {
      if (columns != columns_[i].end() && columns->end == s) ++columns;
      const bool is_in = columns != columns_[i].end() && columns->begin <= s;
      if (model_->constraints[active_[i]].function->depends_on(s) != is_in) return false;
    }
  }
  return true;
}

void ActiveConstraints::set_columns() {
  const Index n = model_->equations->velocities();
  columns_.clear();
  is_dense_ = true;
  for (const std::size_t i : active_) {
    std::vector<Columns> columns;
    for (Index s = 0; s < n; ++s) {
      if (!model_->constraints[i].function->depends_on(s)) {
        is_dense_ = false;
      } else if (!columns.empty() && columns.back().end == s) {
        ++columns.back().end;
      } else {
        columns.push_back({s, s + 1});
      }
    }
    columns_.push_back(std::move(columns));
  }
}

void ActiveConstraints::copy_gradient(std::size_t i, Index row, const Matrix& from, Matrix& to) const {
  const Index rows = from.rows();
  for (const Columns& columns : columns_[i]) {
    for (Index s = columns.begin; s < columns.end; ++s) {
      std::copy_n(from.data() + s * rows, rows, to.data() + s * to.rows() + row);
    }
  }
}

void ActiveConstraints::evaluate(double t, const Vector& q, const Vector& v, Vector& value,
                                 Matrix& gradient) {
  value.resize(size());
  gradient.resize(size(), v.size());
  if (!is_dense_) gradient.setZero();
  Index row = 0;
  for (std::size_t i = 0; i < active_.size(); ++i) {
    const Constraint& constraint = model_->constraints[active_[i]];
    constraint.function->evaluate(t, q, v, values_[i], gradients_[i]);
    if (!is_finite(values_[i]) || !is_finite(gradients_[i])) {
      throw NotFinite("constraint " + constraint.name);
    }
    const Index functions = constraint.function->size();
    value.segment(row, functions) = values_[i];
    copy_gradient(i, row, gradients_[i], gradient);
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
