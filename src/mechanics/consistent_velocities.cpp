#include "mechanics/consistent_velocities.hpp"

#include <cfloat>
#include <cmath>
#include <stdexcept>

#include "mechanics/decompositions/cholesky.hpp"
#include "mechanics/decompositions/least_norm.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::mechanics {
namespace {

bool holds(const Constraint& constraint, double t, const Vector& q) {
  const Schedule& schedule = constraint.schedule;
  if (constraint.unilateral || constraint.friction) return false;
  if (!(schedule.begin < t && t < schedule.end)) return false;
  return !schedule.guard || schedule.guard->value(t, q) > 0;
}

struct Rows {
  Vector value;
  Matrix gradient;
  std::vector<std::size_t> owners;
};

Rows rows_of(const Model& model, double t, const Vector& q, const Vector& v) {
  Rows rows{Vector(0), Matrix(0, v.size()), {}};
  Vector value;
  Matrix gradient;
  for (std::size_t i = 0; i < model.constraints.size(); ++i) {
    if (!holds(model.constraints[i], t, q)) continue;
    model.constraints[i].function->evaluate(t, q, v, value, gradient);
    const Index before = rows.value.size();
    rows.value.conservativeResize(before + value.size());
    rows.value.tail(value.size()) = value;
    rows.gradient.conservativeResize(before + value.size(), v.size());
    rows.gradient.bottomRows(value.size()) = gradient;
    rows.owners.insert(rows.owners.end(), static_cast<std::size_t>(value.size()), i);
  }
  return rows;
}

void refuse_if_off(const Model& model, const Rows& rows, const Vector& v) {
  constexpr double rounding = 1e-12;
  const Eigen::VectorXd sizes = rows.gradient.cwiseAbs() * v.cwiseAbs();
  for (Index row = 0; row < rows.value.size(); ++row) {
    if (std::abs(rows.value[row]) <= rounding * sizes.maxCoeff()) continue;
    const std::string& name = model.constraints[rows.owners[static_cast<std::size_t>(row)]].name;
    throw std::invalid_argument(
        "the velocities given violate constraint " + name + " by " + text::shortest(rows.value[row]) +
        ", whatever those of the other bodies are; allowed: velocities that satisfy it");
  }
}

/// Sets components to 0 that are rounding beside what they are with all kinetic energy.
void take_rounding_away(const Matrix& mass, const std::vector<Index>& open, Vector& v) {
  constexpr double roundings = 16 * DBL_EPSILON;
  const double energy = v.dot(mass * v);
  for (const Index i : open) {
    if (mass(i, i) * v[i] * v[i] <= roundings * roundings * energy) v[i] = 0;
  }
}

}  // namespace

Vector consistent_velocities(const Model& model, double t, const Vector& q, const Vector& v,
                             const std::vector<bool>& given) {
  std::vector<Index> open;
  for (Index i = 0; i < v.size(); ++i) {
    if (!given[static_cast<std::size_t>(i)]) open.push_back(i);
  }
  Vector result = v;
  Rows rows = rows_of(model, t, q, result);
  if (!open.empty() && rows.value.size() > 0) {
    Vector momentum;
    Matrix mass;
    model.equations->momentum(t, q, v, momentum, mass);
    // Of the others: v = L^-T y, with the kinetic energy |y|^2 / 2.
    const auto count = static_cast<Index>(open.size());
    Matrix open_mass(count, count);
    Matrix scaled(count, rows.gradient.rows());
    for (Index j = 0; j < count; ++j) {
      const Index s = open[static_cast<std::size_t>(j)];
      for (Index i = 0; i < count; ++i) open_mass(i, j) = mass(open[static_cast<std::size_t>(i)], s);
      for (Index b = 0; b < scaled.cols(); ++b) scaled(j, b) = rows.gradient(b, s);
    }
    const Cholesky cholesky(open_mass);
    cholesky.solve_l(scaled);
    const LeastNorm equations(scaled.transpose());
    constexpr int refinements = 3;
    for (int k = 0; k < refinements; ++k) {
      Vector change = equations.solve(rows.value);
      cholesky.solve_l_transposed(change);
      for (Index j = 0; j < change.size(); ++j) result[open[static_cast<std::size_t>(j)]] -= change[j];
      take_rounding_away(mass, open, result);
      rows = rows_of(model, t, q, result);
    }
  }
  refuse_if_off(model, rows, result);
  return result;
}

}  // namespace hybrid_sphere::mechanics
